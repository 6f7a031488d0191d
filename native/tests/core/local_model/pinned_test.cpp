// Objects between the tool and a wall, and stacks of them, in a scene whose own solver moves them tick by
// tick: the scene must not throw what is pinned, nor soften it. The truth is the local model left alone.

#include <doctest/doctest.h>

#include "impulse_engine.hpp"
#include "movable_world.hpp"

using namespace haptics;
using namespace haptics::late;

namespace {

constexpr double k_tool_mass = 0.3;
constexpr std::uint64_t k_first = 7;
// of a steady push of 2 N
constexpr double k_loose = 0.005;

struct Pin {
    int count{1};
    /// Mass of each object in tool masses.
    double ratio{1.0};
    double stiffness{15000.0};
    double restitution{0.0};
    TickOrder order{TickOrder::publish_push_move};
    double lost{0.0};
    /// Which of them.
    unsigned seed{1};
    /// Towards the wall, m/s^2.
    double gravity{0.0};
};

struct Pinned {
    double peak{0.0};
    /// Contact force at the end of a push of 2 N.
    double least{1e9};
    double most{0.0};
    /// How much further a push of 4 N gets than one of 2 N.
    double yielded{0.0};
    /// Fastest that an object got in the scene, and farthest from where it was, m.
    double fastest{0.0};
    double farthest{0.0};
};

// pushes with 2 N, then with 4 N; `alone`: the scene says nothing after its first snapshot
Pinned press(const Pin& pin, bool alone) {
    Surface s = shared::paper_surface();
    s.stiffness = pin.stiffness;
    s.restitution = pin.restitution;
    s.static_friction = 0.6;
    s.dynamic_friction = 0.5;
    MovableOptions options;
    options.order = pin.order;
    options.lost = pin.lost;
    options.seed = pin.seed;
    MovableWorld w(shared::box_tool(k_tool_mass), options);
    const double mass = pin.ratio * k_tool_mass;
    const auto start = [](int i) { return 0.0302 + 0.0201 * i; };
    for (int i = 0; i < pin.count; ++i)
        w.add(k_first + static_cast<std::uint64_t>(i), mass, mass * 1.33e-4, Pose(start(i), 0.0, 0.0), s,
              make_box(Vec2::Zero(), Vec2(0.02, 0.02)));
    w.add_fixed(50, s, make_box(Vec2(start(pin.count - 1) + 0.0601, 0.0), Vec2(0.1, 0.4)));
    ImpulseEngine engine;
    w.set_gravity(Vec2(pin.gravity, 0.0));
    w.mover = [&](MovableWorld& x, double dt) {
        for (int i = 0; i < pin.count; ++i)
            x.body(static_cast<std::size_t>(i)).velocity.x() += dt * pin.gravity;
        engine.move(x.bodies(), dt);
    };
    w.hand.held = true;
    w.hand.damping = Vec3(2.0, 2.0, 0.01);
    w.hand.stiffness = Vec3(0.0, 100.0, 2.0);
    Pinned o;
    bool settled = false;
    w.after_step = [&](MovableWorld& x) {
        const double force = -x.output.contact.x();
        o.peak = std::max(o.peak, force);
        if (settled) {
            o.least = std::min(o.least, force);
            o.most = std::max(o.most, force);
        }
    };
    const auto push = [&](double force, double seconds) {
        w.hand.force = Wrench(force - k_tool_mass * pin.gravity, 0.0, 0.0);
        for (int i = 0; i < static_cast<int>(60.0 * seconds); ++i) {
            if (alone)
                w.coast();
            else
                w.tick();
            for (int k = 0; k < pin.count; ++k) {
                const Body& b = w.body(static_cast<std::size_t>(k));
                o.fastest = std::max(o.fastest, b.velocity.head<2>().norm());
                o.farthest = std::max(o.farthest, (b.pose.head<2>() - Vec2(start(k), 0.0)).norm());
            }
        }
        return w.data().pose.x();
    };
    push(2.0, 1.0);
    settled = true;
    const double first = push(2.0, 0.5);
    settled = false;
    o.yielded = push(4.0, 1.5) - first;
    return o;
}

void check(const Pin& pin) {
    CAPTURE(pin.count);
    CAPTURE(pin.ratio);
    CAPTURE(pin.stiffness);
    CAPTURE(pin.restitution);
    CAPTURE(pin.lost);
    CAPTURE(pin.gravity);
    const Pinned seen = press(pin, false);
    const Pinned truth = press(pin, true);
    CHECK(seen.least > 2.0 * (1.0 - k_loose));
    CHECK(seen.most < 2.0 * (1.0 + k_loose));
    // the tool is hard: one spring on it, and two in series wherever else two things touch
    const double series = (1.0 + 2.0 * pin.count) / pin.stiffness;
    CHECK(seen.yielded == doctest::Approx(2.0 * series).epsilon(2.0 * k_loose));
    CHECK(seen.peak < 1.1 * truth.peak);
    CHECK(seen.fastest < 0.05);
    CHECK(seen.farthest < 1e-4 * pin.count + 5e-5); // the gaps it was put there with
}

} // namespace

TEST_CASE("pinned and stacked objects feel as stiff through the scene as without it, and are not thrown") {
    for (const int count : {1, 2, 3})
        for (const double ratio : {1e-3, 0.1, 1.0, 10.0})
            for (const double stiffness : {15000.0, 1e5})
                for (const double lost : {0.0, 0.5}) {
                    Pin pin{count, ratio, stiffness, stiffness > 5e4 ? 0.8 : 0.0};
                    pin.lost = lost;
                    pin.order = count == 2 ? TickOrder::push_move_publish : TickOrder::publish_push_move;
                    check(pin);
                }
}

TEST_CASE("a stack of heavy objects does not tremble, whichever half of the reports is lost") {
    for (const int count : {2, 3})
        for (const unsigned seed : {3U, 4U}) {
            Pin pin{count, 10.0, 1e5, 0.8};
            pin.lost = 0.5;
            pin.seed = seed;
            CAPTURE(seed);
            check(pin);
        }
}

TEST_CASE("the weight of what is pinned stays the scene's") {
    for (const int count : {1, 2})
        for (const double ratio : {1e-3, 0.1, 1.0})
            for (const double lost : {0.0, 0.5}) {
                Pin pin{count, ratio};
                pin.lost = lost;
                pin.gravity = 9.81;
                check(pin);
            }
}

TEST_CASE(
    "through the scene a light object leaves at (1 + e) times the tool's speed, a heavy one is a wall") {
    for (const TickOrder order : {TickOrder::push_move_publish, TickOrder::publish_push_move})
        for (const double lost : {0.0, 0.5})
            for (const double e : {0.0, 0.5, 1.0})
                for (const double stiffness : {2000.0, 15000.0, 1e5})
                    for (const double ratio : {1e-3, 1e3}) {
                        Surface s = shared::paper_surface();
                        s.restitution = e;
                        s.stiffness = stiffness;
                        MovableOptions options;
                        options.order = order;
                        options.lost = lost;
                        MovableWorld w(shared::box_tool(k_tool_mass), options);
                        const double mass = ratio * k_tool_mass;
                        w.add(k_first, mass, mass * 2e-4, Pose(0.0305, 0.0, 0.0), s,
                              make_box(Vec2::Zero(), Vec2(0.02, 0.02)));
                        w.data().velocity = Twist(0.2, 0.0, 0.0);
                        double fastest = 0.0;
                        for (int i = 0; i < 20; ++i) {
                            w.tick();
                            fastest = std::max(fastest, w.body(0).velocity.norm());
                        }
                        CAPTURE(static_cast<int>(order));
                        CAPTURE(lost);
                        CAPTURE(e);
                        CAPTURE(stiffness);
                        CAPTURE(ratio);
                        if (ratio < 1.0) {
                            const double speed = 0.2 * (1.0 + e);
                            CHECK(w.state(k_first)->belief.velocity.x() ==
                                  doctest::Approx(speed).epsilon(0.02));
                            CHECK(w.body(0).velocity.x() == doctest::Approx(speed).epsilon(0.02));
                            CHECK(fastest < 1.02 * speed);
                        } else {
                            CHECK(w.data().velocity.x() == doctest::Approx(-0.2 * e).epsilon(0.02));
                            CHECK(w.body(0).velocity.x() ==
                                  doctest::Approx(0.2e-3 * (1.0 + e)).epsilon(0.02));
                        }
                    }
}

// 0.5 kg on a floor with friction 0.5, so 2.45 N: what slides is told all of the push, for the scene's own
// solver has that friction too; what the friction holds is told nothing.
TEST_CASE("friction that slides is the scene's own, friction that holds answers the push") {
    Surface rough = shared::paper_surface();
    rough.static_friction = rough.dynamic_friction = 0.5;
    auto n = std::make_unique<Neighborhood>();
    n->sequence = 1;
    n->gravity = Vec2(0.0, -9.81);
    Body& object = n->bodies.body[static_cast<std::size_t>(
        shared::add_body(n->bodies, k_first, BodyKind::movable, rough, Pose(0.0302, -0.0150001, 0.0)))];
    object.mass = 0.5;
    object.inertia = 1e3; // it does not tilt
    shared::add_piece(n->bodies, make_box(Vec2::Zero(), Vec2(0.02, 0.04)));
    shared::add_body(n->bodies, 50, BodyKind::fixed, rough, Pose::Zero());
    shared::add_piece(n->bodies, make_box(Vec2(0.0, -0.06), Vec2(4.0, 0.05)));
    for (const double push : {1.0, 4.0}) {
        Model model = shared::box_tool(k_tool_mass);
        model.tool.shape.body[0].surface.static_friction = 0.0;
        model.tool.shape.body[0].surface.dynamic_friction = 0.0;
        auto data = std::make_unique<Data>();
        reset(model, *data, Pose(0.0, -0.015, 0.0));
        take_neighborhood(*n, *data);
        HandInput hand;
        hand.held = true;
        hand.force = Wrench(push, k_tool_mass * 9.81, 0.0);
        StepOutput out;
        double pushed = 0.0;
        Wrench before = Wrench::Zero();
        for (int i = 0; i < 600; ++i) {
            step(model, *data, hand, 0.001, out);
            if (i == 400)
                before = data->movable[0].belief.given;
            if (i > 400)
                pushed -= 0.001 * out.contact.x() + out.collision_impulse.x();
        }
        CAPTURE(push);
        const double told = data->movable[0].belief.given.x() - before.x();
        CHECK(pushed > 0.05);
        if (push < 2.0)
            CHECK(std::abs(told) < 5e-3 * pushed);
        else
            CHECK(told == doctest::Approx(pushed).epsilon(1e-3));
    }
}
