// A box that falls on one corner and tips onto the other: every hit counts, also that of a corner that comes
// down within one step. The truth without friction is a flight from hit to hit: a corner at the lever a that
// closes with u gets the impulse (1 + e) u / (1/m + a^2/I).

#include <haptics/core/local_model/local_model.hpp>
#include <haptics/shared/paper_wall.hpp>

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <memory>

using namespace haptics;

namespace {

constexpr double k_box_mass = 0.3;
constexpr double k_half_length = 0.03;
constexpr double k_half_height = 0.01;
constexpr double k_inertia =
    k_box_mass * (k_half_length * k_half_length + k_half_height * k_half_height) / 3.0;
constexpr double k_time = 0.08;

struct Fall {
    double tilt{0.03};
    double speed{1.0};
    double restitution{0.5};
    double stiffness{1e6};
    double step{1e-3};
    /// Height of the lower corner at the start, m.
    double height{1e-3};
    Integrator integrator{Integrator::linearly_implicit};
    bool reversed{false};
};

struct Motion {
    double height;
    double turn;
    double speed;
    double spin;
};

double energy(const Motion& m) {
    return 0.5 * k_box_mass * m.speed * m.speed + 0.5 * k_inertia * m.spin * m.spin;
}

double lever(double turn, double side) {
    return side * k_half_length * std::cos(turn) + k_half_height * std::sin(turn);
}

double gap(const Motion& m, double side) {
    return m.height + side * k_half_length * std::sin(m.turn) - k_half_height * std::cos(m.turn);
}

double lower_corner(double tilt) {
    return k_half_length * std::sin(tilt) + k_half_height * std::cos(tilt);
}

Motion flight(const Fall& fall) {
    Motion m{lower_corner(fall.tilt) + fall.height, fall.reversed ? -fall.tilt : fall.tilt, -fall.speed, 0.0};
    const auto after = [&](double t) {
        return Motion{m.height + t * m.speed, m.turn + t * m.spin, m.speed, m.spin};
    };
    const auto lowest = [&](const Motion& at) { return std::min(gap(at, 1.0), gap(at, -1.0)); };
    double left = k_time;
    for (int hit = 0; hit < 100; ++hit) {
        constexpr double k_look = 1e-6;
        double t = k_look;
        while (t < left && lowest(after(t)) > 0.0)
            t += k_look;
        if (t >= left)
            break;
        double before = t - k_look;
        while (t - before > 1e-15) {
            const double middle = 0.5 * (before + t);
            (lowest(after(middle)) > 0.0 ? before : t) = middle;
        }
        m = after(before);
        left -= before;
        const double side = gap(m, 1.0) < gap(m, -1.0) ? 1.0 : -1.0;
        const double a = lever(m.turn, side);
        const double impulse =
            -(1.0 + fall.restitution) * (m.speed + a * m.spin) / (1.0 / k_box_mass + a * a / k_inertia);
        m.speed += impulse / k_box_mass;
        m.spin += impulse * a / k_inertia;
    }
    return after(left);
}

// by the local model, with how deep a corner gets
Motion fall_down(const Fall& fall, double& deepest) {
    Surface s;
    s.stiffness = fall.stiffness;
    s.damping = 20.0;
    s.restitution = fall.restitution;
    Model model = shared::box_tool(k_box_mass);
    model.tool.inertia = k_inertia;
    model.tool.shape.piece[0].convex = make_box(Vec2::Zero(), Vec2(2.0 * k_half_length, 2.0 * k_half_height));
    model.settings.integrator = fall.integrator;
    auto data = std::make_unique<Data>();
    reset(model, *data,
          Pose(0.0, lower_corner(fall.tilt) + fall.height, fall.reversed ? -fall.tilt : fall.tilt));
    take_neighborhood(*shared::floor_of(1, s), *data);
    data->velocity = Twist(0.0, -fall.speed, 0.0);
    StepOutput out;
    deepest = 0.0;
    Motion m{};
    for (int i = 0; i < static_cast<int>(k_time / fall.step + 0.5); ++i) {
        step(model, *data, HandInput{}, fall.step, out);
        m = {data->pose.y(), data->pose.z(), data->velocity.y(), data->velocity.z()};
        deepest = std::max({deepest, -gap(m, 1.0), -gap(m, -1.0)});
    }
    return m;
}

template <typename Check>
void for_falls(Fall fall, const Check& check) {
    for (const double tilt : {0.01, 0.03, 0.1})
        for (const double height : {1e-3, 1.3e-3, 1.7e-3})
            for (const double stiffness : {15000.0, 1e6})
                for (const double step : {5e-4, 1e-3, 2e-3})
                    for (const bool reversed : {false, true}) {
                        fall.tilt = tilt;
                        fall.height = height;
                        fall.stiffness = stiffness;
                        fall.step = step;
                        fall.reversed = reversed;
                        CAPTURE(tilt);
                        CAPTURE(height);
                        CAPTURE(stiffness);
                        CAPTURE(step);
                        CAPTURE(reversed);
                        check(fall);
                    }
}

} // namespace

TEST_CASE("a box that tips from corner to corner keeps what the hits leave it") {
    for (const Integrator integrator : {Integrator::linearly_implicit, Integrator::exact}) {
        Fall all;
        all.integrator = integrator;
        CAPTURE(static_cast<int>(integrator));
        const bool exact = integrator == Integrator::exact;
        for_falls(all, [&](const Fall& fall) {
            const Motion truth = flight(fall);
            double deepest = 0.0;
            const Motion m = fall_down(fall, deepest);
            const double rim = k_half_length * std::abs(m.spin - truth.spin);
            CHECK(std::abs(m.speed - truth.speed) < (exact ? 1e-3 : 0.02));
            CHECK(rim < (exact ? 1e-3 : 0.02));
            CHECK(energy(m) == doctest::Approx(energy(truth)).epsilon(exact ? 1e-3 : 0.05));
            CHECK(deepest < 1e-5);
        });
    }
}

TEST_CASE("a box that tips onto its other corner without restitution stays there") {
    for (const Integrator integrator :
         {Integrator::semi_implicit, Integrator::linearly_implicit, Integrator::exact}) {
        Fall all;
        all.integrator = integrator;
        all.restitution = 0.0;
        CAPTURE(static_cast<int>(integrator));
        for_falls(all, [&](Fall fall) {
            if (integrator == Integrator::semi_implicit)
                fall.stiffness = 15000.0; // it bears no more
            double deepest = 0.0;
            const Motion m = fall_down(fall, deepest);
            CHECK(energy(m) < 1e-3 * 0.5 * k_box_mass);
            CHECK(deepest < 1e-5);
        });
    }
}
