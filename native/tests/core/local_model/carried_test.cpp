// Objects that lie on the tool: it bears their weight, which the scene adds tick by tick and hears the answer
// to a tick or more later. The truth is the weight.

#include <doctest/doctest.h>

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

// lies on the tool, which goes up and down by 10 mm every two seconds, in units of its weight
Carried carry(double ratio, TickOrder order, double lost) {
    Surface s = shared::paper_surface();
    s.static_friction = 0.6;
    s.dynamic_friction = 0.5;
    MovableOptions options;
    options.order = order;
    options.lost = lost;
    MovableWorld w(shared::box_tool(k_tool_mass), options);
    const double mass = ratio * k_tool_mass;
    w.add(7, mass, mass * 1.33e-4, Pose(0.0, 0.0201, 0.0), s, make_box(Vec2::Zero(), Vec2(0.02, 0.02)));
    w.set_gravity(Vec2(0.0, -k_fall));
    ImpulseEngine engine;
    w.mover = [&](MovableWorld& x, double dt) {
        x.body(0).velocity.y() -= dt * k_fall;
        engine.move(x.bodies(), dt);
    };
    w.hand.held = true;
    w.hand.damping = Vec3(20.0, 20.0, 0.1);
    w.hand.stiffness = Vec3(1000.0, 1000.0, 10.0);
    w.hand.force = Wrench(0.0, (k_tool_mass + mass) * k_fall, 0.0);
    Carried o;
    bool settled = false;
    int steps = 0;
    w.after_step = [&](MovableWorld& x) {
        w.hand.target.y() = 0.01 * std::sin(3.14159 * x.data().time);
        if (!settled)
            return;
        const double force = -x.output.contact.y() / (mass * k_fall);
        o.least = std::min(o.least, force);
        o.most = std::max(o.most, force);
        o.mean += force;
        ++steps;
    };
    for (int i = 0; i < 210; ++i) {
        settled = i >= 90;
        w.tick();
        if (settled)
            o.apart = std::max(o.apart, std::abs(w.body(0).pose.y() - w.state(7)->belief.pose.y()));
    }
    o.mean /= steps;
    return o;
}

} // namespace

TEST_CASE(
    "the weight of what the tool carries is felt, and stays on the tool when half of the reports are lost") {
    for (const TickOrder order : {TickOrder::push_move_publish, TickOrder::publish_push_move})
        for (const double ratio : {0.1, 1.0, 10.0})
            for (const double lost : {0.0, 0.5}) {
                CAPTURE(static_cast<int>(order));
                CAPTURE(ratio);
                CAPTURE(lost);
                const Carried o = carry(ratio, order, lost);
                CHECK(o.mean == doctest::Approx(1.0).epsilon(0.01));
                CHECK(o.least > (lost > 0.0 ? 0.4 : 0.95));
                CHECK(o.most < (lost > 0.0 ? 1.6 : 1.05));
                CHECK(o.apart < (lost > 0.0 ? 0.3 : 0.01));
            }
}
