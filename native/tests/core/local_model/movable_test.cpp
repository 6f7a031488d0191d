#include <haptics/core/local_model/local_model.hpp>
#include <haptics/shared/paper_wall.hpp>

#include <doctest/doctest.h>

using namespace haptics;

namespace {

constexpr std::uint64_t k_object = 7;

std::unique_ptr<Neighborhood> with_object(double mass, double x, double restitution,
                                          bool wall_behind = false) {
    auto n = std::make_unique<Neighborhood>();
    n->sequence = 1;
    Surface s = shared::paper_surface();
    s.restitution = restitution;
    Body& b = n->bodies.body[static_cast<std::size_t>(
        shared::add_body(n->bodies, k_object, BodyKind::movable, s, Pose(x, 0.0, 0.0)))];
    b.mass = mass;
    b.inertia = mass * 2e-4;
    shared::add_piece(n->bodies, make_box(Vec2::Zero(), Vec2(0.02, 0.02)));
    if (wall_behind) {
        shared::add_body(n->bodies, 8, BodyKind::fixed, shared::paper_surface(), Pose::Zero());
        shared::add_piece(n->bodies, make_box(Vec2(x + 0.01 + 0.02, 0.0), Vec2(0.04, 0.2)));
    }
    return n;
}

} // namespace

TEST_CASE("a free object leaves a heavy tool at (1 + e) times its speed, and a heavy one is a wall") {
    for (const double e : {0.0, 0.5, 1.0})
        for (const double ratio : {1e-3, 1e3}) {
            Model model = shared::box_tool(0.3);
            auto data = std::make_unique<Data>();
            reset(model, *data, Pose(0.0, 0.0, 0.0));
            data->velocity = Twist(0.2, 0.0, 0.0);
            take_neighborhood(*with_object(0.3 * ratio, 0.0305, e), *data);
            StepOutput out;
            for (int i = 0; i < 6; ++i)
                step(model, *data, HandInput{}, 0.001, out);
            CAPTURE(e);
            CAPTURE(ratio);
            REQUIRE(data->movable_count == 1);
            const double object = data->movable[0].belief.velocity.x();
            if (ratio < 1.0)
                CHECK(object == doctest::Approx(0.2 * (1.0 + e)).epsilon(0.02));
            else
                CHECK(data->velocity.x() == doctest::Approx(-0.2 * e).epsilon(0.02));
            // momentum: what the tool lost is what the counter says it gave
            CHECK(data->movable[0].belief.given.x() ==
                  doctest::Approx(0.3 * (0.2 - data->velocity.x())).epsilon(1e-9));
            CHECK(0.3 * ratio * object == doctest::Approx(data->movable[0].belief.given.x()).epsilon(1e-9));
        }
}

TEST_CASE("an object pinned against a wall feels as stiff as both contacts in series") {
    Model model = shared::box_tool(0.3);
    auto data = std::make_unique<Data>();
    reset(model, *data, Pose(0.0, 0.0, 0.0));
    take_neighborhood(*with_object(0.1, 0.0301, 0.0, true), *data);
    HandInput hand;
    hand.held = true;
    StepOutput out;
    const auto settle = [&](double force) {
        hand.force = Wrench(force, 0.0, 0.0);
        for (int i = 0; i < 3000; ++i)
            step(model, *data, hand, 0.001, out);
        return data->pose.x();
    };
    const double one = settle(1.0);
    const double two = settle(2.0);
    // tool-object 15000 N/m (the tool is hard); object-wall: two surfaces of 15000 N/m in series, 7500 N/m
    CHECK(two - one == doctest::Approx(1.0 / 15000.0 + 1.0 / 7500.0).epsilon(0.01));
    CHECK(out.contact.x() == doctest::Approx(-2.0).epsilon(0.01));
}

TEST_CASE("the environment's word about a movable body is taken over once, and softly") {
    Model model = shared::box_tool(0.3);
    auto data = std::make_unique<Data>();
    reset(model, *data, Pose(-0.5, 0.0, 0.0));
    auto n = with_object(0.1, 0.0, 0.0);
    n->tick = 0.02;
    take_neighborhood(*n, *data);
    StepOutput out;
    // the environment has it 1 mm further, tick after tick, and echoes what it was told a tick ago
    MovableBelief told = data->movable[0].belief;
    double largest = 0.0;
    for (int tick = 1; tick < 20; ++tick) {
        const MovableBelief now = data->movable[0].belief;
        n->sequence = static_cast<std::uint64_t>(tick) + 1;
        n->time = data->time;
        n->echo_count = 1;
        n->echo[0] = told;
        n->bodies.body[0].pose = Pose(0.001, 0.0, 0.0);
        take_neighborhood(*n, *data);
        told = now;
        for (int i = 0; i < 20; ++i) {
            const double before = data->movable[0].belief.pose.x();
            step(model, *data, HandInput{}, 0.001, out);
            largest = std::max(largest, std::abs(data->movable[0].belief.pose.x() - before));
        }
    }
    CHECK(data->movable[0].belief.pose.x() == doctest::Approx(0.001).epsilon(1e-9));
    CHECK(largest < 0.001 / 19.0);
}
