// Momentum of the tool and what it pushes, with a double-precision environment in lock-step: whatever gets
// lost on the way to it, what the tool gives is what the environment takes.

#include <doctest/doctest.h>

#include "movable_world.hpp"

using namespace haptics;
using namespace haptics::late;

namespace {

Surface lively() {
    Surface s = shared::paper_surface();
    s.restitution = 0.5;
    return s;
}

// a tool that goes through three free objects
struct Crowd {
    explicit Crowd(const MovableOptions& options)
        : world(shared::box_tool(0.3), options) {
        for (int i = 0; i < 3; ++i)
            world.add(static_cast<std::uint64_t>(7 + i), 0.05 * (i + 1), 2e-5,
                      Pose(0.03 + 0.025 * i, 0.002 * i, 0.0), lively(),
                      make_box(Vec2::Zero(), Vec2(0.02, 0.02)));
        world.data().velocity = Twist(0.2, 0.0, 0.0);
    }
    MovableWorld world;
};

} // namespace

TEST_CASE("momentum of tool and objects drifts less than 1e-9 of its size a second, also with lost reports") {
    for (const TickOrder order : {TickOrder::push_move_publish, TickOrder::publish_push_move})
        for (const double lost : {0.0, 0.5})
            for (const double rate : {30.0, 60.0}) {
                MovableOptions options;
                options.rate = rate;
                options.order = order;
                options.lost = lost;
                Crowd crowd(options);
                MovableWorld& w = crowd.world;
                CAPTURE(static_cast<int>(order));
                CAPTURE(lost);
                CAPTURE(rate);
                const Vec2 start = w.momentum();
                REQUIRE(start.x() == doctest::Approx(0.06));
                const double seconds = 4.0;
                double worst = 0.0;
                for (int i = 0; i < static_cast<int>(seconds * rate); ++i) {
                    w.tick();
                    worst = std::max(worst, (w.momentum() - start).norm() / start.norm());
                }
                CHECK(w.data().velocity.x() < 0.15); // it has pushed something
                CHECK(worst < 1e-9);
                // and what the local model believes is what the environment has
                CHECK((w.believed_momentum() - start).norm() < 1e-9 * start.norm() * seconds);
            }
}

TEST_CASE("an environment that has never heard of the tool's push ends with all of it") {
    MovableOptions options;
    options.lost = 0.9;
    Crowd crowd(options);
    MovableWorld& w = crowd.world;
    for (int i = 0; i < 600; ++i)
        w.tick();
    for (std::size_t i = 0; i < 3; ++i) {
        const Body& b = w.body(i);
        const MovableState* m = w.state(b.id);
        REQUIRE(m != nullptr);
        CHECK(b.mass * b.velocity.x() == doctest::Approx(m->belief.given.x()).epsilon(1e-9));
        CHECK(b.velocity.x() == doctest::Approx(m->belief.velocity.x()).epsilon(1e-6));
    }
}
