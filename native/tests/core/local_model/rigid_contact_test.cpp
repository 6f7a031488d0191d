// A rigid tool among walls takes a path of its own through a step without hits. It moves as in the general
// system, whichever of the two a step takes.

#include <haptics/shared/linkage_tools.hpp>
#include <haptics/shared/linkages.hpp>

#include <doctest/doctest.h>

#include <cmath>

using namespace haptics;

namespace {

// a corner of two walls and a post, still or on the move, of all kinds of surfaces
std::unique_ptr<Neighborhood> walls(shared::Random& random, bool move) {
    auto world = shared::empty_world(Vec2(0.0, random.uniform(-9.81, 0.0)));
    const auto wall = [&](std::uint64_t id, const Vec2& center, const Vec2& size) {
        Surface s;
        s.stiffness = std::pow(10.0, random.uniform(3.0, 5.0));
        s.damping = random.uniform(0.0, 20.0);
        s.dynamic_friction = random.uniform(-0.3, 0.8);
        s.dynamic_friction = std::max(0.0, s.dynamic_friction);
        s.static_friction = 1.2 * s.dynamic_friction;
        s.restitution = std::max(0.0, random.uniform(-0.5, 0.9));
        const auto kind = move ? BodyKind::kinematic : BodyKind::fixed;
        Body& b = world->bodies.body[static_cast<std::size_t>(
            shared::add_body(world->bodies, id, kind, s, Pose(center.x(), center.y(), 0.0)))];
        if (move)
            b.velocity = Twist(random.uniform(-0.05, 0.05), random.uniform(-0.05, 0.05), 0.0);
        shared::add_piece(world->bodies, make_box(Vec2::Zero(), size));
    };
    wall(1, Vec2(0.0, -0.03), Vec2(0.3, 0.04));
    wall(2, Vec2(0.07, 0.05), Vec2(0.04, 0.2));
    wall(3, Vec2(-0.05, 0.0), Vec2(0.01, 0.02));
    return world;
}

struct WallRun {
    WallRun(const Model& of, const Neighborhood& world, const Plan& plan)
        : model(of)
        , data(std::make_unique<Data>()) {
        reset(model, *data, Pose(0.01, 0.02, 0.1));
        auto copy = std::make_unique<Neighborhood>(world);
        copy->plan = plan;
        take_neighborhood(*copy, *data);
    }
    Model model;
    std::unique_ptr<Data> data;
    StepOutput out;
};

bool is_about(const Vec3& a, const Vec3& b) {
    return (a - b).norm() <= 1e-12 * a.norm() + 1e-15;
}

bool same_contact_step(const WallRun& a, const WallRun& b) {
    return a.data->pose == b.data->pose && a.data->velocity == b.data->velocity &&
           a.out.coupling == b.out.coupling && a.out.full_coupling == b.out.full_coupling &&
           a.out.contacts == b.out.contacts && a.out.colliding == b.out.colliding &&
           a.out.sticking == b.out.sticking && a.out.sliding == b.out.sliding &&
           a.out.event_count == b.out.event_count && a.out.max_penetration == b.out.max_penetration &&
           a.out.grip_bias == b.out.grip_bias;
}

bool near_contact_step(const WallRun& a, const WallRun& b) {
    return is_about(a.out.contact, b.out.contact) && is_about(a.out.environment, b.out.environment) &&
           is_about(a.out.grip_acceleration, b.out.grip_acceleration) &&
           std::abs(a.out.source_work - b.out.source_work) <= 1e-12 * std::abs(a.out.source_work) + 1e-15 &&
           std::abs(a.out.stored_energy - b.out.stored_energy) <= 1e-12 * a.out.stored_energy + 1e-15;
}

} // namespace

TEST_SUITE("rigid tool in contact") {
    TEST_CASE("it moves as in the general system, to the last bit") {
        shared::Random random(52);
        int alone = 0;
        int touching = 0;
        for (int i = 0; i < 60; ++i) {
            Model model = shared::box_tool(std::pow(10.0, random.uniform(-2.0, 0.5)));
            model.settings.integrator =
                i % 3 == 0 ? Integrator::semi_implicit : Integrator::linearly_implicit;
            model.settings.contact_mode = i % 5 == 0 ? ContactMode::penalty : ContactMode::penalty_impulse;
            model.tool.grip.pose = i % 2 == 0;
            const double grip_x = random.uniform(-0.02, 0.02);
            model.tool.grip.point = Vec2(grip_x, random.uniform(-0.01, 0.01));
            const auto world = walls(random, i % 4 == 0);
            WallRun general(model, *world, Plan{});
            WallRun own(model, *world, choose_plan(model, *world));
            REQUIRE_FALSE(own.data->plan.runs(Stage::contact_system));
            HandInput hand;
            hand.held = i % 7 != 0;
            hand.stiffness = Vec3(1000.0, 800.0, 1.0) * random.uniform(0.1, 1.0);
            hand.damping = Vec3(10.0, 8.0, 0.01) * random.uniform(0.1, 1.0);
            hand.share = random.uniform(0.3, 1.0);
            if (i % 6 == 0)
                hand.max_force = 2.0;
            const double pace = random.uniform(2.0, 20.0);
            const double reach = random.uniform(0.01, 0.04);
            for (int k = 0; k < 400; ++k) {
                const double t = pace * 0.001 * k;
                hand.target = Pose(reach * std::sin(t), -reach * std::sin(1.7 * t), 0.2 * std::sin(0.8 * t));
                hand.target_velocity = pace * Twist(reach * std::cos(t), -1.7 * reach * std::cos(1.7 * t),
                                                    0.16 * std::cos(0.8 * t));
                step(general.model, *general.data, hand, 0.001, general.out);
                step(own.model, *own.data, hand, 0.001, own.out);
                CAPTURE(i);
                CAPTURE(k);
                REQUIRE(same_contact_step(general, own));
                REQUIRE(near_contact_step(general, own));
                const int felt = own.data->patches.count;
                touching += felt > 0 ? 1 : 0;
                alone += felt > 0 && own.data->system.patches == 0 ? 1 : 0;
            }
        }
        // most steps with contacts took the path of their own, and some the other
        CHECK(alone > 0.8 * touching);
        CHECK(alone < touching);
        CHECK(touching > 5000);
    }
}
