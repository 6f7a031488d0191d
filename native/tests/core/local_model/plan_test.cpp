// A plan leaves out what a scene does not need, says why, and changes nothing.

#include <haptics/shared/linkage_tools.hpp>

#include <doctest/doctest.h>

#include <algorithm>

using namespace haptics;
using shared::linkage_tool;

namespace {

struct Case {
    const char* name;
    Model model;
    std::unique_ptr<Neighborhood> world;
    LinkageVector start;
};

Surface surface(double friction, double restitution) {
    Surface s = shared::paper_surface();
    s.static_friction = 1.2 * friction;
    s.dynamic_friction = friction;
    s.restitution = restitution;
    return s;
}

LinkageVector pose(double x, double y, double angle) {
    return Pose(x, y, angle);
}

std::vector<Case> cases() {
    std::vector<Case> all;
    all.push_back({"nothing near", shared::box_tool(), shared::empty_world(), pose(0, 0.02, 0.1)});
    all.push_back(
        {"smooth floor", shared::box_tool(), shared::floor_of(3, surface(0, 0)), pose(0, 0.013, 0.1)});
    all.push_back(
        {"rough floor", shared::box_tool(), shared::floor_of(1, surface(0.4, 0)), pose(0, 0.013, 0.1)});
    all.push_back(
        {"springy floor", shared::box_tool(), shared::floor_of(1, surface(0.2, 0.7)), pose(0, 0.013, 0.1)});
    auto moving = shared::floor_of(1, surface(0.3, 0.1));
    moving->bodies.body[0].kind = BodyKind::kinematic;
    moving->bodies.body[0].velocity = Twist(0.05, 0.02, 0.1);
    all.push_back({"moving floor", shared::box_tool(), std::move(moving), pose(0, 0.013, 0.1)});
    auto object = shared::floor_of(1, surface(0.3, 0.1));
    Body& b = object->bodies.body[static_cast<std::size_t>(
        shared::add_body(object->bodies, 7, BodyKind::movable, surface(0.2, 0.3), Pose(0.035, 0.01, 0.0)))];
    b.mass = 0.05;
    b.inertia = 1e-5;
    shared::add_piece(object->bodies, make_box(Vec2::Zero(), Vec2(0.02, 0.02)));
    object->gravity = Vec2(0.0, -9.81);
    all.push_back({"an object on a floor", shared::box_tool(), std::move(object), pose(0, 0.013, 0.1)});
    LinkageSpec plain = shared::arm();
    all.push_back(
        {"arm", linkage_tool(plain), shared::floor_of(1, surface(0.3, 0.5)), pose(-0.05, -0.3, 0.2)});
    LinkageSpec rich = shared::chain(4);
    for (LinkSpec& link : rich.links) {
        link.joint.lower_limit = -0.5;
        link.joint.upper_limit = 0.5;
        link.joint.friction = 1e-3;
        link.joint.damping = 1e-4;
    }
    LinkageVector four(4);
    four << 0.1, 0.2, 0.3, -0.2;
    auto weight = shared::empty_world(Vec2(0.0, -9.81));
    all.push_back({"chain with joints under gravity", linkage_tool(rich), std::move(weight), four});
    rich.coriolis = false;
    all.push_back(
        {"the same without Coriolis terms", linkage_tool(rich), shared::empty_world(Vec2(0.0, -9.81)), four});
    return all;
}

struct Run {
    Run(const Case& c, const Plan& plan, Integrator integrator)
        : model(c.model)
        , data(std::make_unique<Data>()) {
        model.settings.integrator = integrator;
        reset(model, *data, c.start);
        auto world = std::make_unique<Neighborhood>(*c.world);
        world->plan = plan;
        take_neighborhood(*world, *data);
        hand.held = true;
        hand.stiffness = Vec3(500.0, 500.0, 0.5);
        hand.damping = Vec3(5.0, 5.0, 0.005);
        home = grip_pose(data->grip, data->pose);
    }
    void step_at(int i) {
        const double t = 0.001 * i;
        hand.target =
            home + Pose(0.01 * std::sin(9.0 * t), -0.01 + 0.01 * std::cos(7.0 * t), 0.1 * std::sin(5.0 * t));
        step(model, *data, hand, 0.001, out);
    }
    Model model;
    std::unique_ptr<Data> data;
    HandInput hand;
    Pose home;
    StepOutput out;
};

bool is_near(const Vec3& a, const Vec3& b) {
    return (a - b).norm() <= 1e-12 * a.norm() + 1e-15;
}

bool left_out(const Plan& plan, const char* stage) {
    for (const PlanLine& line : describe(plan))
        if (line.stage == stage)
            return !line.runs && !line.reason.empty();
    FAIL("no such stage: " << stage);
    return false;
}

} // namespace

TEST_SUITE("plan") {
    TEST_CASE("with the plan or with everything on, the motion is the same to the last bit") {
        for (const Integrator integrator :
             {Integrator::semi_implicit, Integrator::linearly_implicit, Integrator::exact})
            for (const Case& c : cases()) {
                const Plan plan = choose_plan(c.model, *c.world);
                Run full(c, Plan{}, integrator);
                Run planned(c, plan, integrator);
                CAPTURE(c.name);
                bool same = true;
                bool near = true;
                for (int i = 0; i < 1500; ++i) {
                    full.step_at(i);
                    planned.step_at(i);
                    same = same && full.data->pose == planned.data->pose &&
                           full.data->velocity == planned.data->velocity &&
                           full.out.coupling == planned.out.coupling &&
                           full.out.contacts == planned.out.contacts &&
                           full.out.sticking == planned.out.sticking &&
                           full.out.event_count == planned.out.event_count;
                    // sums of many terms, which one path adds about the grip and the other about the center
                    near = near && is_near(full.out.contact, planned.out.contact) &&
                           is_near(full.out.environment, planned.out.environment) &&
                           is_near(full.out.grip_acceleration, planned.out.grip_acceleration) &&
                           std::abs(full.out.source_work - planned.out.source_work) < 1e-15 &&
                           std::abs(full.out.stored_energy - planned.out.stored_energy) <
                               1e-12 * full.out.stored_energy + 1e-18;
                }
                CHECK(same);
                CHECK(near);
                CHECK(plan != Plan{});
            }
    }

    TEST_CASE("each scene leaves out what it does not need, with the reason") {
        const std::vector<Case> all = cases();
        const auto plan_of = [&](const char* name) {
            const auto found = std::find_if(all.begin(), all.end(),
                                            [&](const Case& c) { return std::string_view(c.name) == name; });
            REQUIRE(found != all.end());
            return choose_plan(found->model, *found->world);
        };
        const Plan nothing = plan_of("nothing near");
        for (const char* stage :
             {"contact detection", "moving walls", "movable neighbors", "collision impulses", "restitution",
              "friction", "gravity", "linkage kinematics", "Coriolis terms", "joint limits", "joint friction",
              "joint springs and dampers", "matrices in steps without contact"})
            CHECK(left_out(nothing, stage));
        CHECK(left_out(plan_of("smooth floor"), "friction"));
        CHECK_FALSE(left_out(plan_of("smooth floor"), "contact detection"));
        CHECK_FALSE(left_out(plan_of("rough floor"), "friction"));
        CHECK(left_out(plan_of("rough floor"), "restitution"));
        CHECK_FALSE(left_out(plan_of("springy floor"), "restitution"));
        CHECK_FALSE(left_out(plan_of("moving floor"), "moving walls"));
        CHECK_FALSE(left_out(plan_of("an object on a floor"), "movable neighbors"));
        CHECK_FALSE(left_out(plan_of("an object on a floor"), "gravity"));
        CHECK(left_out(plan_of("rough floor"), "matrices in steps without contact"));
        CHECK_FALSE(left_out(plan_of("arm"), "matrices in steps without contact"));
        CHECK_FALSE(left_out(plan_of("arm"), "linkage kinematics"));
        CHECK(left_out(plan_of("arm"), "joint limits"));
        CHECK_FALSE(left_out(plan_of("chain with joints under gravity"), "joint limits"));
        CHECK_FALSE(left_out(plan_of("chain with joints under gravity"), "joint friction"));
        CHECK_FALSE(left_out(plan_of("chain with joints under gravity"), "collision impulses"));
        CHECK(left_out(plan_of("the same without Coriolis terms"), "Coriolis terms"));
        CHECK(describe(Plan{}).size() == static_cast<std::size_t>(k_stage_count));
    }

    TEST_CASE("a plan is swapped between two steps with its snapshot") {
        Case c{"", shared::box_tool(), shared::empty_world(), pose(0, 0.0095, 0.0)};
        Run run(c, choose_plan(c.model, *c.world), Integrator::linearly_implicit);
        run.step_at(0);
        CHECK(run.out.contacts == 0);
        auto floor = shared::floor_of(1);
        floor->sequence = 2;
        floor->plan = choose_plan(c.model, *floor);
        take_neighborhood(*floor, *run.data);
        run.step_at(1);
        CHECK(run.data->plan.runs(Stage::detection));
        CHECK(run.out.contacts + run.out.colliding > 0);
    }

    TEST_CASE("the kernel is named") {
        CHECK(kernel_name(shared::box_tool()) == "rigid tool, 3 freedoms, fixed size");
        CHECK(kernel_name(linkage_tool(shared::arm())) == "linkage, 3 freedoms, fixed size");
        CHECK(kernel_name(linkage_tool(shared::chain(5))) == "linkage, dense matrix");
        CHECK(kernel_name(linkage_tool(shared::chain(20))) == "long linkage, row by row");
    }
}
