#include <haptics/core/local_model/local_model.hpp>
#include <haptics/shared/paper_wall.hpp>

#include <doctest/doctest.h>

using namespace haptics;

namespace {

std::unique_ptr<Neighborhood> thin_wall(const Surface& surface) {
    auto n = std::make_unique<Neighborhood>();
    n->sequence = 1;
    shared::add_body(n->bodies, 5, BodyKind::fixed, surface, Pose::Zero());
    shared::add_piece(n->bodies, make_box(Vec2(0.0, -0.0005), Vec2(0.4, 0.001)));
    return n;
}

} // namespace

TEST_CASE("a 1 mm wall is not passed at 10 and at 50 m/s, straight, tilted or spinning") {
    for (const ContactMode mode : {ContactMode::penalty_impulse, ContactMode::penalty})
        for (const double speed : {10.0, 50.0})
            for (const double h : {0.001, 0.002})
                for (int i = 0; i < 24; ++i) {
                    Model model = shared::box_tool();
                    model.settings.contact_mode = mode;
                    auto data = std::make_unique<Data>();
                    reset(model, *data, Pose(0.0, 0.05 + 0.001 * i, 0.13 * i));
                    data->velocity = Twist(0.0, -speed, i % 3 == 0 ? 40.0 : 0.0);
                    take_neighborhood(*thin_wall(shared::paper_surface()), *data);
                    StepOutput out;
                    bool touched = false;
                    for (int k = 0; k < 100; ++k) {
                        step(model, *data, HandInput{}, h, out);
                        touched = touched || out.contacts > 0;
                    }
                    CAPTURE(speed);
                    CAPTURE(h);
                    CAPTURE(i);
                    CAPTURE(static_cast<int>(mode));
                    CHECK(touched);
                    CHECK(data->pose.allFinite());
                    // in the end it is, or flies, on its own side
                    CHECK(data->pose.y() > 0.0);
                }
}

TEST_CASE("the softest wall of 1 mm holds the largest force without popping through") {
    Surface soft = shared::paper_surface();
    soft.stiffness = 300.0;
    soft.damping = 2.0;
    for (const double angle : {0.0, 0.4}) {
        Model model = shared::box_tool();
        auto data = std::make_unique<Data>();
        reset(model, *data, Pose(0.0, 0.02, angle));
        take_neighborhood(*thin_wall(soft), *data);
        HandInput hand;
        hand.held = true;
        hand.target = Pose(0.0, 0.0, angle);
        hand.stiffness = Vec3(0.0, 0.0, 1e3);
        hand.damping = Vec3(0.0, 0.0, 1.0);
        StepOutput out;
        for (int i = 0; i < 6000; ++i) {
            hand.force = Wrench(0.0, -8.0 * std::min(1.0, i / 2000.0), 0.0);
            step(model, *data, hand, 0.001, out);
        }
        CHECK(out.contact.y() == doctest::Approx(8.0).epsilon(0.01));
        CHECK(out.max_penetration == doctest::Approx(8.0 / 300.0).epsilon(0.02));
        CHECK(std::abs(out.contact.x()) < 0.01);
    }
}
