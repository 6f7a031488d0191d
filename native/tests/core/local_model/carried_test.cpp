// Objects that lie on the tool: it bears their weight, which the scene adds tick by tick and hears the answer
// to a tick or more later. The truth is m (g + a).

#include <doctest/doctest.h>

#include <utility>

#include "impulse_engine.hpp"
#include "movable_world.hpp"

using namespace haptics;
using namespace haptics::late;

namespace {

constexpr double k_tool_mass = 0.3;
constexpr double k_fall = 9.81;

struct Carried {
    double least{1e9};
    double most{0.0};
    double mean{0.0};
    /// Farthest that the scene had the object from where the tool has it, m.
    double apart{0.0};
};

struct Load {
    /// Boxes on one another, each of so many tool masses.
    int count{1};
    double ratio{1.0};
    TickOrder order{TickOrder::publish_push_move};
    double lost{0.0};
    unsigned seed{1};
    double rate{60.0};
    double seconds{3.5};
    /// The scene tells the gravity of each body, as it does where the tool has none.
    bool own_gravity{false};
};

// lies on the tool, which goes up and down by 10 mm every two seconds; in units of what it then weighs
Carried carry(const Load& load) {
    Surface s = shared::paper_surface();
    s.static_friction = 0.6;
    s.dynamic_friction = 0.5;
    MovableOptions options;
    options.order = load.order;
    options.lost = load.lost;
    options.seed = load.seed;
    options.rate = load.rate;
    MovableWorld w(shared::box_tool(k_tool_mass), options);
    const double mass = load.ratio * k_tool_mass;
    for (int i = 0; i < load.count; ++i)
        w.add(7 + static_cast<std::uint64_t>(i), mass, mass * 1.33e-4, Pose(0.0, 0.0201 * (i + 1), 0.0), s,
              make_box(Vec2::Zero(), Vec2(0.02, 0.02)));
    const double weight = load.count * mass * k_fall;
    if (load.own_gravity)
        for (int i = 0; i < load.count; ++i)
            w.body(static_cast<std::size_t>(i)).acceleration.y() = -k_fall;
    else
        w.set_gravity(Vec2(0.0, -k_fall));
    ImpulseEngine engine;
    w.mover = [&](MovableWorld& x, double dt) {
        for (int i = 0; i < load.count; ++i)
            x.body(static_cast<std::size_t>(i)).velocity.y() -= dt * k_fall;
        engine.move(x.bodies(), dt);
    };
    w.hand.held = true;
    w.hand.damping = Vec3(20.0, 20.0, 0.1);
    w.hand.stiffness = Vec3(1000.0, 1000.0, 10.0);
    w.hand.force = Wrench(0.0, (load.own_gravity ? 0.0 : k_tool_mass * k_fall) + weight, 0.0);
    Carried o;
    bool settled = false;
    int steps = 0;
    double speed = 0.0;
    w.after_step = [&](MovableWorld& x) {
        w.hand.target.y() = 0.01 * std::sin(3.14159 * x.data().time);
        const double before = std::exchange(speed, x.data().velocity.y());
        if (!settled)
            return;
        const double gains = (speed - before) / 0.001;
        const double force = -x.output.contact.y() / (weight * (1.0 + gains / k_fall));
        o.least = std::min(o.least, force);
        o.most = std::max(o.most, force);
        o.mean += force;
        ++steps;
    };
    const int ticks = static_cast<int>(load.rate * load.seconds);
    for (int i = 0; i < ticks; ++i) {
        settled = i >= 1.5 * load.rate;
        w.tick();
        if (settled)
            o.apart = std::max(o.apart, std::abs(w.body(0).pose.y() - w.state(7)->belief.pose.y()));
    }
    o.mean /= steps;
    return o;
}

} // namespace

TEST_CASE("the weight of what the tool carries is felt, alone or stacked, in a scene that hears all") {
    for (const TickOrder order : {TickOrder::push_move_publish, TickOrder::publish_push_move})
        for (const double ratio : {0.1, 1.0, 10.0})
            for (const int count : {1, 2}) {
                CAPTURE(static_cast<int>(order));
                CAPTURE(ratio);
                CAPTURE(count);
                const Carried o = carry({count, ratio, order});
                CHECK(o.mean == doctest::Approx(1.0).epsilon(0.002));
                CHECK(o.least > 0.99);
                CHECK(o.most < 1.01);
                CHECK(o.apart < 0.006);
            }
}

TEST_CASE("the weight of what the tool carries is borne where the scene tells the gravity of each body") {
    for (const TickOrder order : {TickOrder::push_move_publish, TickOrder::publish_push_move})
        for (const double lost : {0.0, 0.5}) {
            CAPTURE(static_cast<int>(order));
            CAPTURE(lost);
            const Carried o = carry({2, 1.0, order, lost, 1, 60.0, 6.0, true});
            CHECK(o.mean == doctest::Approx(1.0).epsilon(0.01));
            CHECK(o.least > (lost > 0.0 ? 0.96 : 0.99));
            CHECK(o.most < (lost > 0.0 ? 1.07 : 1.01));
            CHECK(o.apart < (lost > 0.0 ? 0.15 : 0.006));
        }
}

// With half of the reports lost up to nine in a row are, and an object that nobody holds up falls 0.11 m in
// that time.
TEST_CASE("the weight of what the tool carries does not swing, whichever half of the reports is lost") {
    for (const TickOrder order : {TickOrder::push_move_publish, TickOrder::publish_push_move})
        for (const double ratio : {0.1, 1.0, 10.0})
            for (const int count : {1, 2})
                for (const unsigned seed : {1U, 2U}) {
                    CAPTURE(static_cast<int>(order));
                    CAPTURE(ratio);
                    CAPTURE(count);
                    CAPTURE(seed);
                    const Carried o = carry({count, ratio, order, 0.5, seed});
                    CHECK(o.mean == doctest::Approx(1.0).epsilon(0.01));
                    CHECK(o.least > 0.96);
                    CHECK(o.most < 1.07);
                    CHECK(o.apart < 0.15);
                }
}

// Up to 21 reports in a row are lost here: nobody holds the object in the scene for 0.7 s, and when the scene
// hears at last it is told 7 m/s at once.
TEST_CASE("the weight of what the tool carries is kept when four of five reports at 30 Hz are lost") {
    for (const TickOrder order : {TickOrder::push_move_publish, TickOrder::publish_push_move})
        for (const double ratio : {0.1, 1.0, 10.0})
            for (const unsigned seed : {1U, 3U}) {
                const int count = ratio == 1.0 ? 2 : 1;
                CAPTURE(static_cast<int>(order));
                CAPTURE(ratio);
                CAPTURE(seed);
                const Carried o = carry({count, ratio, order, 0.8, seed, 30.0, 12.0});
                CHECK(o.mean == doctest::Approx(1.0).epsilon(0.02));
                CHECK(o.least > 0.85);
                CHECK(o.most < 1.2);
            }
}
