// A state that no scene can be in is put back, said, and forgotten: whatever made it.

#include <haptics/shared/linkage_tools.hpp>

#include <doctest/doctest.h>

#include <limits>

using namespace haptics;

namespace {

constexpr double k_no_number = std::numeric_limits<double>::quiet_NaN();
constexpr double k_endless = std::numeric_limits<double>::infinity();

struct Held {
    explicit Held(const Model& m, const LinkageVector& start)
        : model(m) {
        reset(model, *data, start);
        auto n = shared::floor_of(1, shared::paper_surface());
        shared::add_body(n->bodies, 9, BodyKind::movable, shared::paper_surface(), Pose(0.3, 0.3, 0.0));
        Body& ball = n->bodies.body[static_cast<std::size_t>(n->bodies.body_count - 1)];
        ball.mass = 0.1;
        ball.inertia = 1e-5;
        shared::add_piece(n->bodies, make_disc(Vec2::Zero(), 0.01));
        take_neighborhood(*n, *data);
        step(model, *data, HandInput{}, 0.001, out);
        CHECK_FALSE(out.diverged);
    }
    LinkageVector place() const {
        return model.tool.articulated ? data->linkage.position : LinkageVector(data->pose);
    }
    void expect_put_back() {
        const LinkageVector before = place();
        step(model, *data, HandInput{}, 0.001, out);
        CHECK(out.diverged);
        CHECK(out.contacts == 0);
        CHECK(out.contact.isZero(0.0));
        CHECK(data->velocity.isZero(0.0));
        const LinkageVector after = place();
        CHECK(after.allFinite());
        if (before.allFinite() && before.cwiseAbs().maxCoeff() < 1e6)
            CHECK(after.isApprox(before));
        for (int i = 0; i < data->movable_count; ++i)
            CHECK(data->movable[static_cast<std::size_t>(i)].belief.pose.allFinite());
        // and life goes on
        for (int i = 0; i < 100; ++i) {
            step(model, *data, HandInput{}, 0.001, out);
            CHECK_FALSE(out.diverged);
        }
    }
    Model model;
    std::unique_ptr<Data> data{std::make_unique<Data>()};
    StepOutput out;
};

LinkageVector one(double value) {
    return LinkageVector::Constant(1, value);
}

} // namespace

TEST_SUITE("a model that ran away") {
    TEST_CASE("a rigid tool is put back at rest") {
        for (const Integrator integrator :
             {Integrator::semi_implicit, Integrator::linearly_implicit, Integrator::exact})
            for (const double absurd : {k_no_number, k_endless, -k_endless, 1e12, 1e300}) {
                Model model = shared::box_tool(0.3);
                model.settings.integrator = integrator;
                Held held(model, Pose(0.0, 0.1, 0.2));
                CAPTURE(absurd);
                held.data->velocity.y() = absurd;
                held.expect_put_back();
                held.data->pose.x() = absurd;
                held.expect_put_back();
            }
    }

    TEST_CASE("so is a linkage") {
        for (const Integrator integrator :
             {Integrator::semi_implicit, Integrator::linearly_implicit, Integrator::exact})
            for (const double absurd : {k_no_number, k_endless, 1e200}) {
                Model model = shared::linkage_tool(shared::door());
                model.settings.integrator = integrator;
                Held held(model, one(0.4));
                CAPTURE(absurd);
                held.data->linkage.velocity[0] = absurd;
                held.expect_put_back();
            }
    }

    TEST_CASE("a movable is put back where its snapshot has it") {
        for (const double absurd : {k_no_number, 1e200}) {
            Held held(shared::box_tool(0.3), Pose(0.0, 0.1, 0.2));
            MovableState& m = held.data->movable[0];
            m.belief.velocity.x() = absurd;
            held.data->neighbors.body[static_cast<std::size_t>(m.body)].velocity.x() = absurd;
            held.expect_put_back();
            CHECK(held.data->movable[0].belief.pose.head<2>().isApprox(Vec2(0.3, 0.3), 1e-6));
        }
    }

    TEST_CASE("the session takes the force off until it is armed again") {
        Model model = shared::linkage_tool(shared::door());
        model.tool.grip = Grip{0, Vec2(0.1, 0.0), false};
        SimulatedHandOptions hand;
        shared::HeldTool held(model, one(0.0), hand);
        held.session->arm();
        for (int i = 0; i < 200; ++i)
            held.session->step();
        REQUIRE(held.session->report().armed);
        held.session->set_rates(one(1e12));
        held.session->step();
        CHECK(has(held.session->report().faults, Fault::make_the_scene_milder));
        CHECK_FALSE(held.session->report().armed);
        for (int i = 0; i < 200; ++i)
            held.session->step();
        CHECK_FALSE(held.session->report().armed);
        held.session->arm();
        for (int i = 0; i < 200; ++i)
            held.session->step();
        CHECK(held.session->report().armed);
    }

    TEST_CASE("a linkage that nobody holds says so too, for good") {
        const Model model = shared::linkage_tool(shared::door());
        SimulatedHandOptions hand;
        shared::HeldTool free(model, one(0.0), hand);
        free.session->step();
        CHECK(free.session->report().faults == Fault::none);
        free.session->set_rates(one(1e12));
        for (int i = 0; i < 3; ++i)
            free.session->step();
        CHECK(has(free.session->report().faults, Fault::make_the_scene_milder));
        CHECK(free.session->report().configuration_rate[0] == 0.0);
    }
}
