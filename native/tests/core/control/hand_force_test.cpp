// What the hand feels of a linkage (design: the S form): statics against the principle of virtual work, on a
// door, a drawer and every link of the paper's arm, with both grips, also where the linkage cannot move.

#include <haptics/shared/linkage_tools.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <numbers>

using namespace haptics;
using shared::HeldTool;
using shared::linkage_tool;

namespace {

LinkageVector coordinates(std::initializer_list<double> values) {
    LinkageVector q(static_cast<Eigen::Index>(values.size()));
    Eigen::Index i = 0;
    for (const double value : values)
        q[i++] = value;
    return q;
}

// mean of the force on the hand and of the contact over the last half second
struct Mean {
    Wrench force{0.0, 0.0, 0.0};
    Wrench contact{0.0, 0.0, 0.0};
    double swing{0.0};
};

Mean settle(HeldTool& tool, double seconds) {
    const double h = tool.session->settings().step;
    const int steps = static_cast<int>(seconds / h);
    const int last = static_cast<int>(0.5 / h);
    Mean mean;
    Wrench low = Wrench::Constant(1e300);
    Wrench high = Wrench::Constant(-1e300);
    for (int i = 0; i < steps; ++i) {
        tool.session->step();
        if (i < steps - last)
            continue;
        mean.force += tool.session->report().force / last;
        mean.contact += tool.session->report().contact / last;
        low = low.cwiseMin(tool.session->report().force);
        high = high.cwiseMax(tool.session->report().force);
    }
    mean.swing = (high - low).head<2>().norm();
    return mean;
}

SimulatedHandOptions still_hand() {
    SimulatedHandOptions hand = path_hand({{0.0, Pose::Zero()}, {100.0, Pose::Zero()}});
    hand.stiffness = 1000.0;
    return hand;
}

} // namespace

TEST_SUITE("hand force") {
    TEST_CASE(
        "a door that is pulled by its end turns under the hand: the angle that nobody holds stores nothing") {
        Model door = linkage_tool(shared::door());
        door.tool.grip = Grip{0, Vec2(0.1, 0.0), false};
        HeldTool tool(door, coordinates({0.0}), pushing_hand(Wrench(0.0, -2.0, 0.0), 0.7));
        tool.session->take(*shared::empty_world());
        const Mean mean = settle(tool, 4.0);
        CHECK(std::abs(tool.session->report().grip.z()) > 1.0);
        CHECK(mean.force.y() == doctest::Approx(2.0).epsilon(0.01));
        // the hand does 0.4 J of work; the spring of the angle alone would hold a joule
        CHECK(tool.session->report().energy_injected < 0.01);
    }

    TEST_CASE("a door against a stop: the hand feels its push back in every direction, the stop the lever's "
              "force") {
        for (const double direction : {0.5, 0.3, 0.7}) {
            // 2 N at the door's end, `direction` pi from the door; the hinge takes what goes along the door
            const Vec2 push =
                2.0 * Vec2(std::cos(direction * std::numbers::pi), std::sin(direction * std::numbers::pi));
            for (const bool pose : {false, true}) {
                Model model = linkage_tool(shared::door());
                model.tool.grip = Grip{0, Vec2(0.1, 0.0), pose};
                HeldTool tool(model, coordinates({0.0}), pushing_hand(Wrench(push.x(), push.y(), 0.0), 0.5));
                auto n = shared::empty_world();
                shared::add_body(n->bodies, 9, BodyKind::fixed, shared::paper_surface(), Pose::Zero());
                shared::add_piece(n->bodies, make_disc(Vec2(0.12, 0.016), 0.01));
                tool.session->take(*n);
                const Mean mean = settle(tool, 6.0);
                CAPTURE(direction);
                CAPTURE(pose);
                CHECK(tool.session->report().faults == Fault::none);
                CHECK((mean.force.head<2>() + push).norm() < 0.02);
                CHECK(mean.contact.head<2>().norm() == doctest::Approx(push.y() * 0.2 / 0.12).epsilon(0.01));
                CHECK(mean.swing < 0.02);
            }
        }
    }

    TEST_CASE("a drawer that stands upright weighs what it weighs, and nothing pulls sideways") {
        LinkageSpec spec = shared::drawer();
        spec.links[0].joint.frame.z() = 0.5 * std::numbers::pi; // slides along y
        for (const bool pose : {false, true}) {
            Model model = linkage_tool(spec);
            model.tool.grip.pose = pose;
            HeldTool tool(model, coordinates({0.0}), still_hand());
            tool.session->take(*shared::empty_world(Vec2(0.0, -9.81)));
            const Mean mean = settle(tool, 6.0);
            CHECK(mean.force.y() == doctest::Approx(-0.3 * 9.81).epsilon(0.02));
            CHECK(std::abs(mean.force.x()) < 0.01);
        }
    }

    TEST_CASE("an arm held by its end is felt by virtual work, contact and weight") {
        // pose grip on the last link: J_h is square, so the force is J_h^-T of all joint torques
        const LinkageVector q = coordinates({0.4, -0.9, 0.7});
        Model model = linkage_tool(shared::arm());
        model.tool.grip = Grip{2, Vec2(0.05, 0.0), true};
        HeldTool tool(model, q, still_hand());
        tool.session->take(*shared::empty_world(Vec2(0.0, -9.81)));
        const Mean mean = settle(tool, 6.0);
        // torques of the weights about the joints at the pose where it settled
        const Pose grip = tool.session->report().grip;
        REQUIRE((grip.head<2>() - tool.session->report().device.head<2>()).norm() < 0.01);
        const LinkageVector& settled = tool.session->configuration();
        Vec3 torque = Vec3::Zero();
        Vec2 joint[4];
        double angle = 0.0;
        joint[0].setZero();
        double angles[3];
        for (int i = 0; i < 3; ++i) {
            angle += settled[i];
            angles[i] = angle;
            joint[i + 1] = joint[i] + rotate(angle, Vec2(0.1, 0.0));
        }
        for (int i = 0; i < 3; ++i)
            for (int link = i; link < 3; ++link) {
                const Vec2 center = joint[link] + rotate(angles[link], Vec2(0.05, 0.0));
                torque[i] += cross(center - joint[i], Vec2(0.0, -0.1 * 9.81));
            }
        Mat3 j; // columns: velocity of the grip for each joint
        for (int i = 0; i < 3; ++i) {
            const Vec2 v = perpendicular(joint[3] - joint[i]);
            j.col(i) = Vec3(v.x(), v.y(), 1.0);
        }
        const Vec3 expected = j.transpose().inverse() * torque;
        CHECK((mean.force - expected).head<2>().norm() < 0.02 * expected.head<2>().norm());
        CHECK(mean.force.z() == doctest::Approx(expected.z()).epsilon(0.02));
    }

    TEST_CASE("every link, both grips, stretched and folded: forces stay bounded and continuous") {
        // along what the arm cannot do, across it, and between
        for (const double direction : {0.3, 1.1, 1.87})
            for (int link = 0; link < 3; ++link)
                for (const bool pose : {false, true})
                    for (const double fold : {0.0, std::numbers::pi}) {
                        LinkageVector q = coordinates({0.3, fold, 0.0});
                        Model model = linkage_tool(shared::arm());
                        model.tool.grip = Grip{link, Vec2(0.05, 0.0), pose};
                        // rest, then 2 cm to and fro at 1 Hz
                        std::vector<HandTarget> path{{0.0, Pose::Zero()}};
                        for (int k = 0; k <= 300; ++k) {
                            const double t = 0.01 * k;
                            const double s = 0.01 * (1.0 - std::cos(2.0 * std::numbers::pi * t));
                            path.push_back(
                                {0.5 + t, Pose(s * std::cos(direction), s * std::sin(direction), 0.0)});
                        }
                        HeldTool tool(model, q, path_hand(path));
                        tool.session->take(*shared::empty_world());
                        double largest = 0.0;
                        double jump = 0.0;
                        double paper_jump = 0.0;
                        Wrench last = Wrench::Zero();
                        Wrench last_paper = Wrench::Zero();
                        const Mat3 device = Vec3(0.3, 0.3, 3e-4).asDiagonal();
                        for (int i = 0; i < 3500; ++i) {
                            tool.session->step();
                            const Wrench& command = tool.session->report().command;
                            // what eq. (3) would give in the same state
                            const StepOutput& out = tool.session->output();
                            const Wrench paper =
                                truncated_mass(out.grip_mobility, device) * out.grip_acceleration;
                            largest = std::max(largest, command.head<2>().norm());
                            jump = std::max(jump, (command - last).head<2>().norm());
                            paper_jump = std::max(paper_jump, (paper - last_paper).head<2>().norm());
                            last = command;
                            last_paper = paper;
                        }
                        CAPTURE(link);
                        CAPTURE(pose);
                        CAPTURE(fold);
                        CAPTURE(direction);
                        CHECK(tool.session->report().faults == Fault::none);
                        CHECK(tool.session->report().armed);
                        // 1000 N/m of the hand over 2 cm is the most that can arise
                        CHECK(largest < 20.0);
                        CHECK(largest > 0.1);
                        CHECK(jump < 0.5);
                        CHECK(paper_jump < 0.5);
                    }
    }

    TEST_CASE("letting go and grabbing another link while running never lets the force jump") {
        LinkageSpec spec = shared::arm();
        for (LinkSpec& link : spec.links)
            link.joint.damping = 2e-3;
        Model model = linkage_tool(spec);
        model.tool.grip = Grip{2, Vec2(0.0, 0.0), true};
        // the handle goes on in a slow circle all the time
        std::vector<HandTarget> path{{0.0, Pose::Zero()}};
        for (int k = 0; k <= 400; ++k) {
            const double a = 2.0 * std::numbers::pi * 0.01 * k;
            const double grow = std::min(1.0, 0.02 * k);
            path.push_back({0.3 + 0.01 * k, 0.01 * grow * Pose(1.0 - std::cos(a), std::sin(a), 0.0)});
        }
        HeldTool tool(model, coordinates({0.4, -0.9, 0.7}), path_hand(path));
        auto n = shared::empty_world();
        tool.session->take(*n);
        for (int i = 0; i < 1000; ++i)
            tool.session->step();
        Wrench last = tool.session->report().force;
        for (int k = 0; k < 6; ++k) {
            // fading out over 0.1 s changes a force by at most 1.5 % a step, and the hand that moves on meets
            // what the linkage cannot do
            const double allowed = std::max(0.15, 0.05 * last.head<2>().norm());
            double largest = 0.0;
            tool.session->grab(Grip{k % 3, Vec2(0.02 * (k % 2), 0.0), k % 2 == 0});
            for (int i = 0; i < 400; ++i) {
                tool.session->step();
                largest = std::max(largest, (tool.session->report().force - last).head<2>().norm());
                last = tool.session->report().force;
                // right after the grab nothing pulls
                if (i == 101)
                    CHECK(last.head<2>().norm() < 0.05);
            }
            CHECK(tool.session->report().held);
            CHECK(largest <= allowed);
        }
        CHECK(tool.session->report().faults == Fault::none);
    }

    TEST_CASE(
        "a hand at rest that takes hold of a swinging link catches it: the force starts at zero and changes "
        "by at most 0.05 N a step") {
        for (const bool four : {false, true})
            for (const double speed : {0.5, 2.0, 5.0})
                for (const double rate_hz : {500.0, 1000.0}) {
                    CAPTURE(four);
                    CAPTURE(speed);
                    CAPTURE(rate_hz);
                    Model model = linkage_tool(shared::door());
                    model.tool.grip = Grip{0, Vec2(0.05, 0.0), false};
                    SessionSettings settings;
                    settings.step = 1.0 / rate_hz;
                    settings.coupling = four ? Coupling::four_channel : Coupling::virtual_coupling;
                    settings.hold_at_start = false;
                    HeldTool tool(model, coordinates({0.4}), still_hand(), settings);
                    Session& session = *tool.session;
                    session.take(*shared::empty_world());
                    const auto run = [&](double seconds, double& largest) {
                        for (int i = 0; i < static_cast<int>(seconds * rate_hz); ++i) {
                            const Wrench last = session.report().force;
                            session.step();
                            largest = std::max(largest, (session.report().force - last).head<2>().norm());
                        }
                    };
                    double before = 0.0;
                    run(0.8, before);
                    CHECK(before == 0.0);
                    session.set_rates(LinkageVector(coordinates({speed})));
                    session.hold(true);
                    double largest = 0.0;
                    run(1.0, largest);
                    CHECK(session.report().held);
                    CHECK(largest <= 0.05);
                    // caught: what is left of the swing is none
                    CHECK(std::abs(session.report().configuration_rate[0]) < 0.02 * speed + 1e-3);
                }
    }

    TEST_CASE("the truncated inverse is the inverse where it can be, and never more than 50 devices") {
        const Mat3 device = Vec3(0.3, 0.4, 3e-4).asDiagonal();
        Mat3 mobility = Vec3(4.0, 3.0, 5000.0).asDiagonal();
        mobility(0, 1) = mobility(1, 0) = 1.0;
        CHECK((truncated_mass(mobility, device) * mobility - Mat3::Identity()).norm() < 1e-12);
        Mat3 last = Mat3::Zero();
        double jump = 0.0;
        for (double x = 1e-6; x < 10.0; x *= 1.001) {
            const Mat3 mass = truncated_mass(Vec3(x, 4.0, 5000.0).asDiagonal(), device);
            CHECK(mass(0, 0) <= 50.0 * 0.3);
            if (x > 1e-6)
                jump = std::max(jump, (mass - last).norm());
            last = mass;
        }
        CHECK(jump < 0.1);
        CHECK(truncated_mass(Mat3::Zero(), device).norm() == 0.0);
    }
}
