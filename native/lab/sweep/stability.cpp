// While a tool of mass m rests on a spring-damper, semi-implicit steps of T give for the disturbance x
//     x'' -> (x+ - 2 x + x-) / T^2 = -(K / m) x - (B / m) (x - x-) / T,
// whose roots leave the unit circle (through -1) at K T^2 + 2 B T = 4 m.
//
// The residual of a continuous contact falls, the slower the lighter its damping; a step that adds nothing
// keeps it at or below its start. The energy of a disturbance that semi-implicit steps keep sways by a
// constant factor near the bound, so the residual, not the first swing, tells growth.

#include <haptics/core/geometry/shapes.hpp>
#include <haptics/core/local_model/local_model.hpp>
#include <haptics/sweep/stability.hpp>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

namespace haptics::sweep {

std::string_view name_of(Verdict verdict) {
    switch (verdict) {
    case Verdict::stable:
        return "stable";
    case Verdict::chattering:
        return "chattering";
    case Verdict::unstable:
        return "unstable";
    }
    return "";
}

double semi_implicit_floor(double stiffness, double damping, double step) {
    return 0.25 * (stiffness * step * step + 2.0 * damping * step);
}

Verdict classify(double growth, double residual, double bounce) {
    // a figure that is not a number fails every comparison
    if (!(residual <= k_grown) || !std::isfinite(growth) || !std::isfinite(bounce))
        return Verdict::unstable;
    return residual <= k_allowed && bounce <= k_allowed ? Verdict::stable : Verdict::chattering;
}

namespace {

constexpr double k_wall_disc = 0.01;
constexpr double k_wall_push = 2.0;

struct Wall {
    explicit Wall(const StabilityPoint& point)
        : stiffness(point.stiffness)
        , mass(point.mass)
        , step(1.0 / point.rate) {
        ToolModel& tool = model.tool;
        tool.mass = point.mass;
        tool.inertia = 0.5 * point.mass * k_wall_disc * k_wall_disc;
        tool.shape.body_count = tool.shape.piece_count = 1;
        tool.shape.body[0].kind = BodyKind::tool;
        tool.shape.body[0].surface = neutral_surface();
        tool.shape.body[0].piece_count = 1;
        tool.shape.piece[0].id = 1;
        tool.shape.piece[0].convex = make_disc(Vec2::Zero(), k_wall_disc);
        model.settings.integrator = point.integrator;
        model.settings.strictly_semi_implicit = !point.gives_way;
        model.settings.contact_mode = ContactMode::penalty;
        scene.sequence = 1;
        scene.bodies.body_count = scene.bodies.piece_count = 1;
        Body& body = scene.bodies.body[0];
        body.id = 1;
        body.surface.stiffness = point.stiffness;
        body.surface.damping = point.damping;
        body.piece_count = 1;
        scene.bodies.piece[0].id = 1;
        scene.bodies.piece[0].convex = make_half_plane(Vec2::Zero(), Vec2(0.0, 1.0));
    }
    void start(double gap, double speed, double push) {
        reset(model, *data, Pose(0.0, k_wall_disc + gap, 0.0));
        data->velocity.y() = speed;
        ++scene.sequence;
        take_neighborhood(scene, *data);
        hand.held = push != 0.0;
        hand.force.y() = -push;
    }
    void go() { haptics::step(model, *data, hand, step, out); }
    [[nodiscard]] double gap() const { return data->pose.y() - k_wall_disc; }

    Model model;
    Neighborhood scene;
    std::unique_ptr<Data> data{std::make_unique<Data>()};
    HandInput hand;
    StepOutput out;
    double stiffness;
    double mass;
    double step;
};

// energy above that of rest at equilibrium
double disturbance(const Wall& w, double push) {
    const double rest = -push / w.stiffness;
    const double gap = w.gap();
    const double speed = w.data->velocity.y();
    const double spring = 0.5 * w.stiffness * (std::min(gap, 0.0) * std::min(gap, 0.0) - rest * rest);
    return 0.5 * w.mass * speed * speed + spring + push * (gap - rest);
}

} // namespace

StabilityFigures judge(const StabilityPoint& point) {
    StabilityFigures f;
    const auto wall = std::make_unique<Wall>(point);
    Wall& w = *wall;
    // Pressed and disturbed by a tenth of the speed that would just lift it: semi-implicit steps at 1.1 times
    // their floor swing three times as far as the continuous motion, and must not lift either.
    const double frequency = std::sqrt(point.stiffness / point.mass);
    const double rest = k_wall_push / point.stiffness;
    w.start(-rest, 0.1 * rest * frequency, k_wall_push);
    const double first = disturbance(w, k_wall_push);
    constexpr int k_steps = 2000;
    for (int i = 0; i < k_steps; ++i) {
        w.go();
        const double now = disturbance(w, k_wall_push) / first;
        if (!std::isfinite(now)) {
            f.growth = f.residual = now;
            break;
        }
        f.growth = std::max(f.growth, now);
        if (i >= k_steps * 3 / 4)
            f.residual = std::max(f.residual, now);
    }
    // thrown at it
    constexpr double k_speed = 0.2;
    constexpr int k_phases = 4;
    const double longest = 2.0 * std::numbers::pi / frequency + 4.0 * point.damping / point.stiffness;
    const auto limit = static_cast<int>(std::min(2e5, longest * point.rate)) + 100;
    for (int phase = 0; phase < k_phases; ++phase) {
        w.start(k_speed * w.step * (0.1 + static_cast<double>(phase) / k_phases), -k_speed, 0.0);
        bool touched = false;
        for (int i = 0; i < limit; ++i) {
            w.go();
            touched = touched || w.out.contact.y() != 0.0;
            if (touched && w.out.contact.y() == 0.0 && w.data->velocity.y() >= 0.0)
                break;
        }
        const double share = w.data->velocity.y() / k_speed;
        f.bounce = std::isfinite(share) ? std::max(f.bounce, share * share) : share;
        if (!std::isfinite(share))
            break;
    }
    f.verdict = classify(f.growth, f.residual, f.bounce);
    return f;
}

} // namespace haptics::sweep
