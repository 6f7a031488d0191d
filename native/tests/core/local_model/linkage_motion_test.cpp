// What a linkage does by itself, and against a wall that loses nothing, with all three integrators: the
// period and the amplitude of a pendulum (elliptic integral), the momentum and the energy of a floating
// chain, the energy of a bounce.

#include <haptics/core/dynamics/energy.hpp>
#include <haptics/core/dynamics/kinematics.hpp>
#include <haptics/shared/linkage_tools.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

using namespace haptics;

namespace {

constexpr Integrator k_all[] = {Integrator::semi_implicit, Integrator::linearly_implicit, Integrator::exact};

// seconds between upward crossings of the lowest place, and the greatest angle of the last two seconds
struct Swing {
    double period{0.0};
    double amplitude{0.0};
};

Swing swing(Integrator integrator, double start, double dt, double seconds) {
    Model model = shared::linkage_tool(shared::door());
    model.settings.integrator = integrator;
    auto data = std::make_unique<Data>();
    take_neighborhood(*shared::empty_world(Vec2(0.0, -9.81)), *data);
    LinkageVector q(1);
    q[0] = start - 0.5 * std::numbers::pi;
    reset(model, *data, q);
    StepOutput out;
    Swing result;
    double first = -1.0;
    double last = -1.0;
    int swings = -1;
    double before = start;
    for (int i = 0; i < static_cast<int>(seconds / dt); ++i) {
        step(model, *data, HandInput{}, dt, out);
        const double angle = data->linkage.position[0] + 0.5 * std::numbers::pi;
        if (before < 0.0 && angle >= 0.0) {
            last = (i + 1) * dt - dt * angle / (angle - before);
            first = first < 0.0 ? last : first;
            ++swings;
        }
        if (i * dt > seconds - 2.0)
            result.amplitude = std::max(result.amplitude, angle);
        before = angle;
    }
    result.period = (last - first) / swings;
    return result;
}

// The leapfrog has its velocities half a step before its positions.
Momentum momentum_of(const Model& model, const Data& data) {
    LinkageData now = data.linkage;
    if (model.settings.integrator != Integrator::exact)
        now.velocity += data.half_step;
    update_kinematics(model.tool.linkage, now);
    return total_momentum(model.tool.linkage, now);
}

} // namespace

TEST_SUITE("motion of a linkage") {
    TEST_CASE("a pendulum swings with the period of the elliptic integral and keeps its amplitude") {
        for (const Integrator integrator : k_all)
            for (const double dt : {0.001, 0.004})
                for (const double start : {0.05, 1.0, 2.5}) {
                    const Swing s = swing(integrator, start, dt, 20.0);
                    // rod of 0.2 m: T = 4 sqrt(2 l / 3 g) K(sin(start / 2))
                    const double period =
                        4.0 * std::sqrt(0.4 / 3.0 / 9.81) * std::comp_ellint_1(std::sin(0.5 * start));
                    CAPTURE(static_cast<int>(integrator));
                    CAPTURE(dt);
                    CAPTURE(start);
                    CHECK(s.period == doctest::Approx(period).epsilon(4.0 * dt * dt));
                    CHECK(s.amplitude == doctest::Approx(start).epsilon(2e-3));
                }
    }

    TEST_CASE("a floating chain keeps its momentum and energy, ever better with shorter steps") {
        for (const Integrator integrator : k_all)
            for (const int links : {2, 5})
                for (const double dt : {0.002, 0.0005}) {
                    Model model = shared::linkage_tool(shared::chain(links, BaseKind::floating));
                    model.settings.integrator = integrator;
                    auto data = std::make_unique<Data>();
                    take_neighborhood(*shared::empty_world(), *data);
                    shared::Random random(11);
                    LinkageVector q(links + 2);
                    for (double& x : q)
                        x = random.uniform(-1.0, 1.0);
                    reset(model, *data, q);
                    for (double& v : data->linkage.velocity)
                        v = random.uniform(-6.0, 6.0);
                    StepOutput out;
                    // the leapfrog finds its half step
                    for (int i = 0; i < 10; ++i)
                        step(model, *data, HandInput{}, dt, out);
                    const Momentum start = momentum_of(model, *data);
                    const double energy = kinetic_energy(model.tool.linkage, data->linkage);
                    for (int i = 0; i < static_cast<int>(1.0 / dt); ++i)
                        step(model, *data, HandInput{}, dt, out);
                    const Momentum end = momentum_of(model, *data);
                    CAPTURE(static_cast<int>(integrator));
                    CAPTURE(links);
                    CAPTURE(dt);
                    const double mass = 0.1 * links;
                    const double size = std::sqrt(2.0 * mass * energy);
                    const double allowed = 500.0 * dt * dt;
                    CHECK((end.linear - start.linear).norm() < allowed * size);
                    CHECK(std::abs(end.angular - start.angular) < allowed * size * 0.1 * links);
                }
    }

    TEST_CASE("the exact integrator gives a door back what it hits a lossless wall with") {
        for (const bool corner : {false, true})
            for (const double stiffness : {1e3, 1.5e4, 1e6, 1e8})
                for (const double speed : {1.0, 5.0, 15.0, 30.0})
                    for (const double phase : {0.0, 0.3, 0.8}) {
                        Model model = shared::linkage_tool(shared::door());
                        model.settings.integrator = Integrator::exact;
                        model.settings.contact_mode = ContactMode::penalty;
                        auto data = std::make_unique<Data>();
                        auto n = shared::empty_world();
                        Surface surface;
                        surface.stiffness = stiffness;
                        surface.damping = 0.0;
                        // the door's face on a disc, or its end's corner on a slope
                        shared::add_body(n->bodies, 9, BodyKind::fixed, surface,
                                         corner ? Pose(0.0, -0.06, -0.1) : Pose(0.15, -0.03, 0.0));
                        shared::add_piece(n->bodies, corner ? make_box(Vec2(0.0, -0.05), Vec2(1.0, 0.1))
                                                            : make_disc(Vec2::Zero(), 0.01));
                        take_neighborhood(*n, *data);
                        LinkageVector q(1);
                        q[0] = phase * 0.002 * speed;
                        reset(model, *data, q);
                        data->linkage.velocity[0] = -speed;
                        StepOutput out;
                        int gave_way = 0;
                        for (int i = 0; i < 800 && !(data->linkage.velocity[0] > 0.0 && out.contacts == 0);
                             ++i) {
                            step(model, *data, HandInput{}, 0.002, out);
                            gave_way += out.exact_gave_way ? 1 : 0;
                        }
                        CAPTURE(corner);
                        CAPTURE(stiffness);
                        CAPTURE(speed);
                        CAPTURE(phase);
                        CHECK(gave_way == 0);
                        const double returned = data->linkage.velocity[0] / speed;
                        CHECK(returned * returned ==
                              doctest::Approx(1.0).epsilon(speed > 20.0 ? 5e-3 : 2e-3));
                    }
    }

    // Its first link turns with `speed`, the second with it, until one of them hits the floor.
    TEST_CASE("the exact integrator gives chains back what they hit a lossless wall with") {
        for (const int links : {2, 3})
            for (const double stiffness : {1.5e4, 1e6, 1e8})
                for (const double speed : {1.0, 5.0, 15.0})
                    for (const double phase : {0.0, 0.3, 0.8}) {
                        // a whip of 60 rad/s loses by itself, and edges that tilt while soft walls hold them
                        if (links == 3 && speed > 5.0)
                            continue;
                        Model model = shared::linkage_tool(shared::chain(links));
                        model.settings.integrator = Integrator::exact;
                        model.settings.contact_mode = ContactMode::penalty;
                        auto data = std::make_unique<Data>();
                        auto n = shared::empty_world();
                        Surface surface;
                        surface.stiffness = stiffness;
                        surface.damping = 0.0;
                        shared::add_body(n->bodies, 9, BodyKind::fixed, surface, Pose(0.0, -0.03, 0.0));
                        shared::add_piece(n->bodies, make_box(Vec2(0.0, -0.05), Vec2(4.0, 0.1)));
                        take_neighborhood(*n, *data);
                        LinkageVector q = LinkageVector::Zero(links);
                        q[0] = 0.1 + phase * 0.001 * speed;
                        reset(model, *data, q);
                        data->linkage.velocity[0] = -speed;
                        update_kinematics(model.tool.linkage, data->linkage);
                        const double energy = kinetic_energy(model.tool.linkage, data->linkage);
                        StepOutput out;
                        int gave_way = 0;
                        bool touched = false;
                        for (int i = 0; i < 1000 && !(touched && out.contacts == 0); ++i) {
                            step(model, *data, HandInput{}, 0.001, out);
                            gave_way += out.exact_gave_way ? 1 : 0;
                            touched = touched || out.contacts > 0;
                        }
                        CAPTURE(links);
                        CAPTURE(stiffness);
                        CAPTURE(speed);
                        CAPTURE(phase);
                        CHECK(gave_way == 0);
                        CHECK(kinetic_energy(model.tool.linkage, data->linkage) ==
                              doctest::Approx(energy).epsilon(0.01));
                    }
    }
}
