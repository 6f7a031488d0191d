#include <haptics/core/local_model/local_model.hpp>
#include <haptics/shared/paper_wall.hpp>

#include <doctest/doctest.h>

using namespace haptics;

namespace {

struct Result {
    double force;
    double depth;
    double angle;
};

// the tool starts 1 mm above the floor, turned by `angle`, and is pushed down at its center with 2 N for 3 s;
// the exact integrator for 1 s, which costs as much (the slowest mode fades with 30 ms)
Result push(Integrator integrator, double angle, int pieces, double x, double rate, bool fixed_angle) {
    Model model = shared::box_tool();
    model.settings.integrator = integrator;
    auto data = std::make_unique<Data>();
    const double half_height = 0.02 * std::abs(std::sin(angle)) + 0.01 * std::cos(angle);
    reset(model, *data, Pose(x, half_height + 0.001, angle));
    take_neighborhood(*shared::floor_of(pieces), *data);
    HandInput hand;
    hand.held = true;
    hand.force = Wrench(0.0, -2.0, 0.0);
    if (fixed_angle) {
        hand.target = Pose(0.0, 0.0, angle);
        hand.stiffness = Vec3(0.0, 0.0, 1e4);
        hand.damping = Vec3(0.0, 0.0, 10.0);
    }
    StepOutput out;
    Result r{0.0, 0.0, 0.0};
    const int steps = static_cast<int>((integrator == Integrator::exact ? 1.0 : 3.0) * rate);
    for (int i = 0; i < steps; ++i)
        step(model, *data, hand, 1.0 / rate, out);
    r.force = out.contact.y();
    r.depth = out.max_penetration;
    r.angle = data->pose.z();
    return r;
}

} // namespace

TEST_CASE("a steady 2 N push on the paper's wall gives 2 N and 133 um") {
    for (const Integrator integrator :
         {Integrator::semi_implicit, Integrator::linearly_implicit, Integrator::exact})
        for (const double rate : {500.0, 1000.0, 4000.0})
            for (const int pieces : {1, 2, 3, 7})
                for (const double x : {0.0, 0.0137}) {
                    CAPTURE(rate);
                    CAPTURE(pieces);
                    CAPTURE(x);
                    const Result edge = push(integrator, 0.0, pieces, x, rate, false);
                    CHECK(edge.force == doctest::Approx(2.0).epsilon(0.01));
                    CHECK(edge.depth == doctest::Approx(2.0 / 15000.0).epsilon(0.01));
                    CHECK(std::abs(edge.angle) < 1e-6);
                    const Result corner = push(integrator, 0.5, pieces, x, rate, true);
                    CHECK(corner.force == doctest::Approx(2.0).epsilon(0.01));
                    CHECK(corner.depth == doctest::Approx(2.0 / 15000.0).epsilon(0.01));
                }
}

TEST_CASE("a box that is held at a point comes to rest on its edge however hard it is pushed") {
    for (const Integrator integrator :
         {Integrator::semi_implicit, Integrator::linearly_implicit, Integrator::exact})
        for (const double rate : {500.0, 1000.0})
            for (const double force : {5.0, 20.0, 40.0})
                for (const double tilt : {0.02, 0.05, 0.2}) {
                    CAPTURE(static_cast<int>(integrator));
                    CAPTURE(rate);
                    CAPTURE(force);
                    CAPTURE(tilt);
                    Model model = shared::box_tool();
                    model.settings.integrator = integrator;
                    model.tool.grip = Grip{0, Vec2(0.0, 0.0), false};
                    auto data = std::make_unique<Data>();
                    reset(model, *data, Pose(0.0, 0.02 * std::sin(tilt) + 0.0105, tilt));
                    take_neighborhood(*shared::floor_of(1), *data);
                    HandInput hand;
                    hand.held = true;
                    hand.force = Wrench(0.0, -force, 0.0);
                    hand.damping = Vec3(2.0, 2.0, 0.0);
                    StepOutput out;
                    double rocks = 0.0;
                    for (int i = 0; i < static_cast<int>(rate); ++i) {
                        step(model, *data, hand, 1.0 / rate, out);
                        if (i > static_cast<int>(0.9 * rate))
                            rocks = std::max(rocks, std::abs(data->pose.z()));
                    }
                    CHECK(rocks < 1e-3);
                    CHECK(out.contact.y() == doctest::Approx(force).epsilon(0.01));
                    CHECK(out.max_penetration == doctest::Approx(force / 15000.0).epsilon(0.02));
                }
}
