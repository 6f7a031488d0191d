// A rigid tool that touches nothing moves by a formula of its own, in steps with and without it alike.

#include <haptics/shared/linkage_tools.hpp>
#include <haptics/shared/linkages.hpp>

#include <doctest/doctest.h>

#include <cmath>

using namespace haptics;

namespace {

struct RandomHand {
    HandInput hand;
    Grip grip;
    double mass{0.1};
    Vec2 gravity{0.0, 0.0};
};

// one draw a statement: compilers differ in the order of arguments
Vec3 random_vector(shared::Random& random, double size) {
    Vec3 v;
    for (int i = 0; i < 3; ++i)
        v[i] = random.uniform(-size, size);
    return v;
}

RandomHand draw_hand(shared::Random& random, bool held) {
    RandomHand r;
    r.mass = std::pow(10.0, random.uniform(-3.0, 1.0));
    r.gravity = random_vector(random, 9.81).head<2>();
    r.grip.point = random_vector(random, 0.05).head<2>();
    r.grip.pose = random.uniform(0.0, 1.0) < 0.5;
    r.hand.held = held;
    r.hand.stiffness = Vec3(2000.0, 1500.0, 2.0) * random.uniform(0.0, 1.0);
    r.hand.damping = Vec3(20.0, 15.0, 0.02) * random.uniform(0.0, 1.0);
    r.hand.share = random.uniform(0.2, 1.0);
    if (random.uniform(0.0, 1.0) < 0.3)
        r.hand.max_force = 0.5;
    r.hand.force = random_vector(random, 0.1);
    return r;
}

struct FreeRun {
    FreeRun(const RandomHand& drawn, Integrator integrator, bool general)
        : model(shared::box_tool(drawn.mass))
        , data(std::make_unique<Data>()) {
        model.settings.integrator = integrator;
        model.tool.grip = drawn.grip;
        reset(model, *data, Pose(0.01, -0.02, 0.3));
        auto world = shared::empty_world(drawn.gravity);
        world->plan = general ? Plan{} : choose_plan(model, *world);
        take_neighborhood(*world, *data);
    }
    Model model;
    std::unique_ptr<Data> data;
    StepOutput out;
};

bool same_step(const FreeRun& a, const FreeRun& b) {
    return a.data->pose == b.data->pose && a.data->velocity == b.data->velocity &&
           a.out.coupling == b.out.coupling && a.out.full_coupling == b.out.full_coupling &&
           a.out.environment == b.out.environment && a.out.grip_acceleration == b.out.grip_acceleration &&
           a.out.grip_bias == b.out.grip_bias && a.out.grip_mobility == b.out.grip_mobility &&
           a.out.source_work == b.out.source_work && a.out.stored_energy == b.out.stored_energy;
}

} // namespace

TEST_SUITE("free rigid tool") {
    TEST_CASE("it moves as in the general system, to the last bit") {
        shared::Random random(41);
        for (int i = 0; i < 200; ++i) {
            const RandomHand drawn = draw_hand(random, i % 4 != 0);
            const Integrator integrator =
                i % 2 == 0 ? Integrator::linearly_implicit : Integrator::semi_implicit;
            FreeRun general(drawn, integrator, true);
            FreeRun free(drawn, integrator, false);
            REQUIRE_FALSE(free.data->plan.runs(Stage::free_system));
            HandInput hand = drawn.hand;
            for (int k = 0; k < 50; ++k) {
                hand.target = random_vector(random, 0.05);
                hand.target_velocity = random_vector(random, 0.5);
                step(general.model, *general.data, hand, 0.001, general.out);
                step(free.model, *free.data, hand, 0.001, free.out);
                REQUIRE(same_step(general, free));
            }
        }
    }

    TEST_CASE("a fall is that of Newton, whatever the mass") {
        RandomHand drawn;
        drawn.gravity = Vec2(0.0, -9.81);
        for (const double mass : {1e-3, 0.1, 10.0}) {
            drawn.mass = mass;
            FreeRun run(drawn, Integrator::linearly_implicit, false);
            run.data->velocity = Twist(0.2, 0.1, 3.0);
            for (int k = 0; k < 500; ++k)
                step(run.model, *run.data, drawn.hand, 0.001, run.out);
            CHECK(run.data->velocity.y() == doctest::Approx(0.1 - 9.81 * 0.5));
            CHECK(run.data->pose.x() == doctest::Approx(0.01 + 0.2 * 0.5));
            CHECK(run.data->pose.z() == doctest::Approx(0.3 + 3.0 * 0.5));
            // symplectic Euler: h g t / 2 beyond the parabola
            const double parabola = -0.02 + 0.1 * 0.5 - 0.5 * 9.81 * 0.25;
            CHECK(run.data->pose.y() == doctest::Approx(parabola - 0.5 * 0.001 * 9.81 * 0.5));
        }
    }
}
