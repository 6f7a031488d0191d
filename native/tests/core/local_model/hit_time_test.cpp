// Hits that forces bring about within a step: what the velocity at its start does not foresee.

#include <haptics/core/local_model/local_model.hpp>
#include <haptics/shared/paper_wall.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

using namespace haptics;

namespace {

constexpr double k_coarse_step = 0.002;

struct Bounce {
    bool hit{false};
    // speed that it leaves with over the one that it came with, both at the height of the touch
    double ratio{0.0};
};

// the box falls `height` to the floor, thrown down with 0.4 m/s
Bounce fall(Integrator integrator, const Surface& surface, double gravity, double height) {
    Model model = shared::box_tool(0.3);
    model.settings.integrator = integrator;
    auto data = std::make_unique<Data>();
    reset(model, *data, Pose(0.0, 0.01 + height, 0.0));
    data->velocity = Twist(0.0, -0.4, 0.0);
    auto scene = shared::floor_of(1, surface);
    scene->gravity = Vec2(0.0, -gravity);
    take_neighborhood(*scene, *data);
    const double came = std::sqrt(0.4 * 0.4 + 2.0 * gravity * height);
    Bounce bounce;
    StepOutput out;
    for (int i = 0; i < 60; ++i) {
        step(model, *data, HandInput{}, k_coarse_step, out);
        bounce.hit = bounce.hit || out.colliding > 0;
        const double above = data->pose.y() - 0.01;
        const double up = data->velocity.y();
        if (above > 0.0 && up > 0.0) {
            bounce.ratio = std::sqrt(up * up + 2.0 * gravity * above) / came;
            break;
        }
    }
    return bounce;
}

} // namespace

TEST_CASE(
    "a falling tool bounces with its restitution wherever in the step it lands, however stiff the floor") {
    double worst = 0.0;
    for (const Integrator integrator :
         {Integrator::semi_implicit, Integrator::linearly_implicit, Integrator::exact})
        for (const double stiffness : {15000.0, 1e6})
            for (const double restitution : {0.5, 0.9})
                for (int phase = 0; phase < 60; ++phase) {
                    CAPTURE(static_cast<int>(integrator));
                    CAPTURE(stiffness);
                    CAPTURE(phase);
                    Surface surface = shared::paper_surface();
                    surface.stiffness = stiffness;
                    surface.restitution = restitution;
                    const Bounce b =
                        fall(integrator, surface, 9.81, 0.004 + 0.4 * k_coarse_step * phase / 60.0);
                    CHECK(b.hit);
                    worst = std::max(worst, std::abs(b.ratio - restitution));
                }
    // what is left is the fall, of first order in the step
    CHECK(worst < 0.01);
}

TEST_CASE("a push that drives the tool onto the floor within a step is a hit, a slow one is not") {
    for (const double push : {1.0, 30.0}) {
        Model model = shared::box_tool(0.3);
        auto data = std::make_unique<Data>();
        // at rest: nothing is foreseen; 30 N reach the floor with 0.1 m/s, 1 N with 3 mm/s
        reset(model, *data, Pose(0.0, 0.01 + (push > 2.0 ? 50e-6 : 1e-6), 0.0));
        take_neighborhood(*shared::floor_of(1), *data);
        HandInput hand;
        hand.held = true;
        hand.force = Wrench(0.0, -push, 0.0);
        StepOutput out;
        int hits = 0;
        for (int i = 0; i < 50; ++i) {
            step(model, *data, hand, 0.001, out);
            hits += out.colliding;
        }
        CHECK(hits == (push > 2.0 ? 1 : 0));
    }
}
