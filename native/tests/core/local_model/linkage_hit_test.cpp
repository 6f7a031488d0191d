// What walls that move and free bodies give to a linkage by hitting it: the rigid answer in closed form; and
// next to a joint, where nothing can give way, not the rate that a rigid hit would need, wall speed over
// lever.

#include <haptics/shared/linkage_tools.hpp>

#include <doctest/doctest.h>

#include <support/allocation_guard.hpp>

using namespace haptics;

namespace {

constexpr double k_length = 0.2; // of the door, from its hinge at the origin along x; 1 cm thick

// a disc below the door at x = `lever` moves up at `speed` from `gap` under it
struct Pressed {
    Pressed(double lever, double speed, double gap, Integrator integrator)
        : model(shared::linkage_tool(shared::door())) {
        model.settings.integrator = integrator;
        reset(model, *data, LinkageVector::Zero(1));
        auto n = shared::empty_world();
        shared::add_body(n->bodies, 9, BodyKind::kinematic, shared::paper_surface(),
                         Pose(lever, -0.015 - gap, 0.0));
        n->bodies.body[0].velocity = Twist(0.0, speed, 0.0);
        shared::add_piece(n->bodies, make_disc(Vec2::Zero(), 0.01));
        take_neighborhood(*n, *data);
    }
    // greatest rate of the door in so many steps of 1 ms
    double run(int steps) {
        double most = 0.0;
        StepOutput out;
        const testing::AllocationGuard guard;
        for (int i = 0; i < steps; ++i) {
            step(model, *data, HandInput{}, 0.001, out);
            most = std::max(most, std::abs(data->linkage.velocity[0]));
        }
        CHECK(guard.allocations() == 0);
        return most;
    }
    Model model;
    std::unique_ptr<Data> data{std::make_unique<Data>()};
};

} // namespace

TEST_SUITE("hits on a linkage") {
    TEST_CASE(
        "the door's rate stays within the wall's speed over 0.6 % of its length, however short the lever") {
        for (const Integrator integrator :
             {Integrator::semi_implicit, Integrator::linearly_implicit, Integrator::exact})
            for (const double speed : {0.05, 0.3, 2.0})
                for (const double gap : {1e-3, 0.0, -1e-3})
                    for (const double lever :
                         {0.0, 1e-12, 1e-9, -1e-9, 1e-6, 1e-5, 1e-4, -1e-4, 5e-4, 2e-3}) {
                        Pressed t(lever, speed, gap, integrator);
                        CAPTURE(static_cast<int>(integrator));
                        CAPTURE(speed);
                        CAPTURE(gap);
                        CAPTURE(lever);
                        // 40 ms: the wall comes 12 mm far at 0.3 m/s, through the door
                        const double most = t.run(40);
                        const double e = shared::paper_surface().restitution;
                        // what its spring adds: K = 15 kN/m over 1 cm on 4e-3 kg m^2
                        const double spring = 20.0;
                        CHECK(most < (1.0 + e) * speed / (0.006 * k_length) + spring);
                        CHECK(std::isfinite(t.data->linkage.position[0]));
                    }
    }

    TEST_CASE("with a lever that counts the door takes the rate of the rigid hit") {
        for (const double lever : {2e-3, 0.01, 0.1, 0.15})
            for (const Integrator integrator :
                 {Integrator::semi_implicit, Integrator::linearly_implicit, Integrator::exact}) {
                Pressed t(lever, 0.3, 1e-4, integrator);
                StepOutput out;
                step(t.model, *t.data, HandInput{}, 0.001, out);
                CAPTURE(lever);
                const double e = shared::paper_surface().restitution;
                CHECK(t.data->linkage.velocity[0] == doctest::Approx((1.0 + e) * 0.3 / lever).epsilon(0.01));
            }
    }

    TEST_CASE("a ball that hits a door at rest gives it what conservation about the hinge asks") {
        for (const double lever : {0.02, 0.1, 0.19})
            for (const double mass : {0.01, 0.3, 5.0})
                for (const double e : {0.0, 0.5, 1.0})
                    for (const Integrator integrator :
                         {Integrator::semi_implicit, Integrator::linearly_implicit, Integrator::exact}) {
                        Model model = shared::linkage_tool(shared::door());
                        model.settings.integrator = integrator;
                        auto data = std::make_unique<Data>();
                        reset(model, *data, LinkageVector::Zero(1));
                        Surface surface = shared::paper_surface();
                        surface.restitution = e;
                        auto n = shared::empty_world();
                        shared::add_body(n->bodies, 9, BodyKind::movable, surface, Pose(lever, -0.0151, 0.0));
                        Body& ball = n->bodies.body[0];
                        ball.velocity = Twist(0.0, 0.3, 0.0);
                        ball.mass = mass;
                        ball.inertia = 0.5 * mass * 1e-4;
                        shared::add_piece(n->bodies, make_disc(Vec2::Zero(), 0.01));
                        take_neighborhood(*n, *data);
                        StepOutput out;
                        step(model, *data, HandInput{}, 0.001, out);
                        const double inertia = 4e-3;
                        const double impulse = (1.0 + e) * 0.3 / (1.0 / mass + lever * lever / inertia);
                        CAPTURE(lever);
                        CAPTURE(mass);
                        CAPTURE(e);
                        CAPTURE(static_cast<int>(integrator));
                        CHECK(data->linkage.velocity[0] ==
                              doctest::Approx(impulse * lever / inertia).epsilon(0.01));
                        CHECK(data->neighbors.body[0].velocity.y() ==
                              doctest::Approx(0.3 - impulse / mass).epsilon(0.01));
                    }
    }

    TEST_CASE(
        "a ball that meets the door again once the door is at its stop bounces off again, in the same step") {
        for (const double above : {1e-5, 5e-5})
            for (const double mass : {0.3, 5.0})
                for (const double e : {0.4, 0.8})
                    for (const Integrator integrator :
                         {Integrator::semi_implicit, Integrator::linearly_implicit, Integrator::exact}) {
                        constexpr double k_lever = 0.1;
                        LinkageSpec spec = shared::door();
                        spec.links[0].joint.lower_limit = -1.0;
                        spec.links[0].joint.upper_limit = above / k_lever;
                        Model model = shared::linkage_tool(spec);
                        model.settings.integrator = integrator;
                        auto data = std::make_unique<Data>();
                        reset(model, *data, LinkageVector::Zero(1));
                        Surface surface = shared::paper_surface();
                        surface.restitution = e;
                        auto n = shared::empty_world();
                        shared::add_body(n->bodies, 9, BodyKind::movable, surface,
                                         Pose(k_lever, -0.0151, 0.0));
                        Body& ball = n->bodies.body[0];
                        ball.velocity = Twist(0.0, 0.5, 0.0);
                        ball.mass = mass;
                        ball.inertia = 0.5 * mass * 1e-4;
                        shared::add_piece(n->bodies, make_disc(Vec2::Zero(), 0.01));
                        take_neighborhood(*n, *data);
                        StepOutput out;
                        step(model, *data, HandInput{}, 0.001, out);
                        const double door = 4e-3 / (k_lever * k_lever);
                        const double first = (mass - e * door) / (mass + door) * 0.5;
                        CAPTURE(above);
                        CAPTURE(mass);
                        CAPTURE(e);
                        CAPTURE(static_cast<int>(integrator));
                        // what still moves on towards the door meets it at rest
                        const double expected = first > 0.0 ? -e * first : first;
                        CHECK(data->neighbors.body[0].velocity.y() ==
                              doctest::Approx(expected).epsilon(0.02));
                    }
    }
}
