// What appears or leaves while the tool stands in it.

#include <haptics/core/contact/seams.hpp>
#include <haptics/core/local_model/local_model.hpp>
#include <haptics/shared/paper_wall.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <vector>

using namespace haptics;

namespace {

// a tool that a hand of 200 N/m presses on whatever the current list of bodies has
class FadingScene {
  public:
    explicit FadingScene(const Convex* shape = nullptr)
        : model(shared::box_tool())
        , data(std::make_unique<Data>())
        , next(std::make_unique<Neighborhood>()) {
        if (shape != nullptr)
            model.tool.shape.piece[0].convex = *shape;
        reset(model, *data, Pose(0.0, 0.0099, 0.0));
        hand.held = true;
        hand.stiffness = Vec3(200.0, 200.0, 10.0);
        hand.damping = Vec3(8.0, 8.0, 0.02);
        hand.target = Pose(0.0, 0.0, 0.0);
    }
    void clear() { next->bodies.body_count = next->bodies.piece_count = 0; }
    Body& add(std::uint64_t id, BodyKind kind, const Convex& shape,
              const Surface& s = shared::paper_surface(), const Pose& pose = Pose::Zero()) {
        Body& b =
            next->bodies.body[static_cast<std::size_t>(shared::add_body(next->bodies, id, kind, s, pose))];
        b.mass = 0.2;
        b.inertia = 1e-4;
        shared::add_piece(next->bodies, shape);
        next->bodies.piece[static_cast<std::size_t>(next->bodies.piece_count - 1)].id =
            static_cast<std::uint32_t>(id);
        return b;
    }
    void publish() {
        mark_seams(next->bodies);
        ++next->sequence;
        next->time = data->time;
        take_neighborhood(*next, *data);
    }
    void run(int steps) {
        for (int i = 0; i < steps; ++i) {
            step(model, *data, hand, 0.001, out);
            const Wrench change = out.contact - last;
            largest = std::max(largest, change.head<2>().norm());
            largest_torque = std::max(largest_torque, std::abs(change.z()));
            hits += out.colliding;
            last = out.contact;
        }
    }
    void watch() {
        largest = largest_torque = 0.0;
        hits = 0;
    }

    Model model;
    std::unique_ptr<Data> data;
    std::unique_ptr<Neighborhood> next;
    HandInput hand;
    StepOutput out;
    Wrench last{0.0, 0.0, 0.0};
    double largest{0.0};
    double largest_torque{0.0};
    int hits{0};
};

const Convex k_floor = make_box(Vec2(0.0, -0.01), Vec2(0.2, 0.02));

double allowed(double force) {
    return std::max(0.07 * force, 0.05);
}

} // namespace

TEST_CASE("a touched body that leaves fades within 50 ms and leaves no ghost") {
    const Convex disc = make_disc(Vec2::Zero(), 0.01);
    for (const Convex* shape : {static_cast<const Convex*>(nullptr), &disc})
        for (const BodyKind kind : {BodyKind::fixed, BodyKind::kinematic, BodyKind::movable}) {
            FadingScene s(shape);
            Body& floor = s.add(7, kind, k_floor);
            floor.mass = 1e3; // hardly yields
            floor.inertia = 10.0;
            s.publish();
            s.run(600);
            const double force = s.last.y();
            REQUIRE(force > 1.5);
            s.clear();
            s.publish();
            s.watch();
            s.run(1);
            CHECK(s.last.y() == doctest::Approx(force).epsilon(0.02));
            s.run(20);
            CHECK(s.last.y() > 0.1 * force); // it fades, it is not cut off
            s.run(32);
            CHECK(s.largest < allowed(force));
            CHECK(s.last.norm() == 0.0);
            CHECK(s.out.contacts == 0);
            CHECK(s.data->neighbors.body_count == 0);
            CHECK(s.hits == 0);
        }
}

TEST_CASE("what leaves is let go of as soon as the tool is off it") {
    FadingScene s;
    s.add(7, BodyKind::fixed, k_floor);
    s.publish();
    s.run(400);
    s.hand.target.y() = 0.05;
    s.clear();
    s.publish();
    s.run(30);
    CHECK(s.data->pose.y() > 0.0101);
    CHECK(s.data->neighbors.body_count == 0);
}

TEST_CASE("a body that appears around the tool fades in, pushes it out gently and is not run into") {
    const Convex disc = make_disc(Vec2::Zero(), 0.01);
    for (const Convex* shape : {static_cast<const Convex*>(nullptr), &disc})
        for (const BodyKind kind : {BodyKind::fixed, BodyKind::kinematic, BodyKind::movable})
            for (const double speed : {0.0, 0.05}) {
                FadingScene s(shape);
                s.hand.target.y() = 0.0097;
                s.publish();
                s.run(500);
                s.data->velocity.y() = -speed; // would be a hit
                Body& floor = s.add(7, kind, k_floor);
                floor.mass = 1e3;
                floor.inertia = 10.0;
                s.publish();
                s.watch();
                CAPTURE(speed);
                s.run(2);
                CHECK(s.largest < 0.05);
                double most = 0.0;
                double fastest = 0.0;
                int steps = 2;
                for (; steps < 60 && s.data->track[0].presence < 1.0; ++steps) {
                    s.run(1);
                    most = std::max(most, s.last.y());
                    fastest = std::max(fastest, s.data->velocity.y());
                }
                CHECK(s.hits == 0);
                CHECK(most > 0.3);
                // at rest as at an update; else as the motion in a wall that is all there
                CHECK(s.largest < std::max(0.05, 0.5 * 15000.0 * 0.001 * speed));
                // the spring alone would give 0.067 m/s for a depth of 0.3 mm
                CHECK(fastest < (speed > 0.0 ? 0.9 * speed : 0.02));
                s.run(1000);
                CHECK(s.out.contacts == 1);
                // in the end it is as stiff as it should be
                CHECK(s.last.y() == doctest::Approx(15000.0 * s.out.max_penetration).epsilon(1e-3));
            }
}

TEST_CASE("a movable body that the scene puts where the tool is fades in and pushes it out gently") {
    FadingScene s;
    s.hand.target.y() = 0.0097;
    Body& floor = s.add(7, BodyKind::movable, k_floor, shared::paper_surface(), Pose(0.0, -0.2, 0.0));
    floor.mass = 1e3;
    floor.inertia = 10.0;
    s.publish();
    s.run(500);
    REQUIRE(s.data->movable_count == 1);
    s.publish();
    s.run(17);
    s.next->echo_count = 1;
    s.next->echo[0] = s.data->movable[0].belief;
    floor.pose = Pose::Zero();
    s.publish();
    CHECK(s.data->neighbors.body[0].pose.y() == doctest::Approx(0.0).epsilon(1e-12));
    CHECK(s.data->track[0].presence == 0.0);
    s.watch();
    double fastest = 0.0;
    for (int i = 0; i < 60; ++i) {
        s.run(1);
        fastest = std::max(fastest, s.data->velocity.y());
    }
    CHECK(s.hits == 0);
    CHECK(s.largest < 0.05);
    CHECK(fastest < 0.02);
    s.run(1000);
    CHECK(s.last.y() == doctest::Approx(15000.0 * s.out.max_penetration).epsilon(1e-3));
}

TEST_CASE("what appears deep in the tool moves it out gently, however stiff, and not at once") {
    const Convex inside = make_disc(Vec2(0.003, 0.0099), 0.003);
    const Convex blade = make_box(Vec2(0.0, 0.008), Vec2(0.2, 0.001));
    for (const Convex* shape : {&k_floor, &inside, &blade})
        for (const BodyKind kind : {BodyKind::fixed, BodyKind::kinematic})
            for (const double stiffness : {2000.0, 15000.0, 100000.0}) {
                FadingScene s;
                s.data->pose.y() = s.hand.target.y() = 0.008;
                s.publish();
                s.run(50);
                Surface surface = shared::paper_surface();
                surface.stiffness = stiffness;
                s.add(7, kind, *shape, surface);
                s.publish();
                s.watch();
                CAPTURE(stiffness);
                double most = 0.0;
                double fastest = 0.0;
                for (int i = 0; i < 300; ++i) {
                    if (i % 16 == 0)
                        s.publish();
                    s.run(1);
                    most = std::max(most, s.last.head<2>().norm());
                    fastest = std::max(fastest, s.data->velocity.head<2>().norm());
                }
                CHECK(s.largest < 0.1);
                CHECK(fastest < 0.15); // its own spring would give up to 5 m/s
                CHECK(most < 3.0);
                CHECK(s.hits == 0);
                s.run(1500);
                CHECK(s.out.contacts == 1);
                CHECK(std::abs(s.last.y()) ==
                      doctest::Approx(stiffness * s.out.max_penetration).epsilon(1e-3));
                CHECK(s.data->track[0].presence == 1.0);
            }
}

TEST_CASE("what appears in a tool that is pressed on holds it as the wall that it is") {
    for (const double stiffness : {2000.0, 15000.0, 100000.0})
        for (const double depth : {0.0005, 0.003}) {
            FadingScene s;
            s.data->pose.y() = s.hand.target.y() = 0.01 - depth;
            s.publish();
            s.run(50);
            Surface surface = shared::paper_surface();
            surface.stiffness = stiffness;
            s.add(7, BodyKind::fixed, k_floor, surface);
            s.publish();
            s.watch();
            s.hand.force.y() = -2.0; // from now on
            double lowest = 1.0;
            for (int i = 0; i < 400; ++i) {
                s.run(1);
                lowest = std::min(lowest, s.data->pose.y());
            }
            CAPTURE(stiffness);
            CAPTURE(depth);
            const double sank = 0.01 - depth - lowest;
            CHECK(sank < 2.0 / stiffness + 0.001);
            s.run(800);
            CHECK(s.last.y() == doctest::Approx(stiffness * s.out.max_penetration).epsilon(1e-3));
        }
}

TEST_CASE("a body that appears free of the tool is whole when it is hit") {
    FadingScene s;
    s.hand.held = false;
    Surface lively = shared::paper_surface();
    lively.restitution = 0.8;
    s.data->pose.y() = 0.0103;
    s.data->velocity.y() = -0.2;
    s.publish();
    s.run(1);
    s.add(7, BodyKind::fixed, k_floor, lively);
    s.publish();
    s.run(5);
    CHECK(s.data->velocity.y() == doctest::Approx(0.16).epsilon(0.02));
}

TEST_CASE("a wall that is replaced by its like is not felt") {
    Surface rough = shared::paper_surface();
    rough.static_friction = rough.dynamic_friction = 0.5;
    for (const int pieces : {1, 4}) {
        FadingScene s;
        s.hand.force = Wrench(0.5, 0.0, 0.0);
        const auto list = [&](std::uint64_t first) {
            s.clear();
            const double width = 0.2 / pieces;
            for (int i = 0; i < pieces; ++i)
                s.add(first + static_cast<std::uint64_t>(i), BodyKind::fixed,
                      make_box(Vec2(-0.1 + (i + 0.5) * width, -0.01), Vec2(width, 0.02)), rough);
            s.publish();
        };
        list(10);
        s.run(600);
        const Pose settled = s.data->pose;
        s.watch();
        for (std::uint64_t k = 2; k < 12; ++k) {
            list(10 * k);
            s.run(35); // faster than the fade
        }
        CHECK(s.largest < 1e-3);
        CHECK(s.largest_torque < 1e-5);
        CHECK(s.hits == 0);
        CHECK(s.out.sticking == 1);
        CHECK((s.data->pose - settled).norm() < 1e-6);
    }
}

TEST_CASE("of a tool on two tiles one leaves: the force stays, its point moves over") {
    for (const bool seams : {false, true})
        for (const std::uint64_t leaves : {std::uint64_t{1}, std::uint64_t{2}}) {
            FadingScene s;
            const auto list = [&](bool both) {
                s.clear();
                if (both || leaves == 2)
                    s.add(1, BodyKind::fixed, make_box(Vec2(-0.049, -0.01), Vec2(0.1, 0.02)));
                if (both || leaves == 1)
                    s.add(2, BodyKind::fixed, make_box(Vec2(0.051, -0.01), Vec2(0.1, 0.02)));
                if (seams) {
                    s.publish();
                    return;
                }
                ++s.next->sequence;
                s.next->time = s.data->time;
                take_neighborhood(*s.next, *s.data);
            };
            s.hand.stiffness.z() = 100.0; // holds the tool level
            list(true);
            s.run(600);
            const double force = s.last.y();
            const double torque = s.last.z();
            list(false);
            s.watch();
            s.run(200);
            CAPTURE(seams);
            CAPTURE(leaves);
            CHECK(std::abs(s.last.z() - torque) > 0.005);
            CHECK(s.last.y() == doctest::Approx(force).epsilon(0.02));
            CHECK(s.largest < 0.05);
            CHECK(s.largest_torque < 0.07 * std::abs(s.last.z() - torque));
        }
}

TEST_CASE("a body that leaves and comes back at once goes on from where it was") {
    FadingScene s;
    s.add(7, BodyKind::kinematic, k_floor);
    s.publish();
    s.run(600);
    const double force = s.last.y();
    s.watch();
    for (int i = 0; i < 6; ++i) {
        if (i % 2 == 0)
            s.clear();
        else
            s.add(7, BodyKind::kinematic, k_floor);
        s.publish();
        s.run(12);
    }
    s.run(300);
    CHECK(s.largest < allowed(force));
    CHECK(s.last.y() == doctest::Approx(force).epsilon(0.001));
    CHECK(s.hits == 0);
}

TEST_CASE("the wall behind a pinned object leaves without a jump in the hand") {
    FadingScene s;
    const auto list = [&](bool wall) {
        s.clear();
        s.add(7, BodyKind::movable, make_box(Vec2::Zero(), Vec2(0.03, 0.02)), shared::paper_surface(),
              Pose(0.0, -0.01, 0.0));
        if (wall)
            s.add(8, BodyKind::fixed, make_box(Vec2(0.0, -0.03), Vec2(0.2, 0.02)));
        s.publish();
    };
    list(true);
    s.run(600);
    const double force = s.last.y();
    REQUIRE(force > 1.5);
    list(false);
    s.watch();
    s.run(200);
    CHECK(s.largest < allowed(force));
}

TEST_CASE("full lists leave no room to fade, and nothing breaks") {
    FadingScene s;
    s.add(7, BodyKind::fixed, k_floor);
    s.publish();
    s.run(300);
    s.clear();
    for (int i = 0; i < k_max_bodies; ++i)
        s.add(static_cast<std::uint64_t>(100 + i), BodyKind::kinematic,
              make_disc(Vec2(0.01 * i, 1.0), 0.001));
    s.publish();
    s.run(100);
    CHECK(s.last.norm() == 0.0);
    CHECK(s.data->neighbors.body_count == k_max_bodies);
}
