#include <haptics/core/contact/detection.hpp>

#include <doctest/doctest.h>

#include <numbers>

#include "contact_scenes.hpp"

using namespace haptics;
using namespace haptics::testing;

namespace {

/// A tool with one piece above one fixed piece.
struct Scene {
    std::unique_ptr<BodySet> tool{make_set()};
    std::unique_ptr<BodySet> neighbors{make_set()};
    DetectionSettings settings;
    PatchList patches;

    Scene(const Convex& tool_shape, const Pose& pose) {
        add_body(*tool, 0, BodyKind::tool, pose, {tool_shape});
    }
    void detect() { detect_patches(*tool, *neighbors, settings, patches, patches); }
};

} // namespace

TEST_CASE("a level box on a half-plane is one patch with two ends of equal share") {
    Scene scene(make_box(Vec2{0, 0}, Vec2{0.02, 0.01}), Pose{0.003, 0.0049, 0.0});
    add_body(*scene.neighbors, 7, BodyKind::fixed, Pose{0, 0, 0}, {make_half_plane(Vec2{0, 0}, Vec2{0, 1})});
    scene.detect();
    REQUIRE(scene.patches.count == 1);
    const Patch& patch = scene.patches.patch[0];
    REQUIRE(patch.point_count == 2);
    CHECK(patch.normal.y() == 1.0);
    for (std::size_t i = 0; i < 2; ++i) {
        CHECK(patch.point[i].gap == doctest::Approx(-1e-4).epsilon(1e-9));
        CHECK(patch.point[i].weight == 0.5);
        CHECK(std::abs(patch.point[i].position.y()) < 1e-15);
    }
    CHECK(std::abs(patch.point[0].position.x() - patch.point[1].position.x()) == doctest::Approx(0.02));
    CHECK(patch.body_a == 0);
    CHECK(patch.body_b == 1);
}

TEST_CASE("a box on its corner has one point with the whole share") {
    Scene scene(make_box(Vec2{0, 0}, Vec2{0.02, 0.02}),
                Pose{0, 0.01 * std::sqrt(2.0) - 5e-5, std::numbers::pi / 4});
    add_body(*scene.neighbors, 7, BodyKind::fixed, Pose{0, -0.05, 0}, {make_box(Vec2{0, 0}, Vec2{0.3, 0.1})});
    scene.detect();
    REQUIRE(scene.patches.count == 1);
    const Patch& patch = scene.patches.patch[0];
    REQUIRE(patch.point_count == 1);
    CHECK(patch.point[0].weight == 1.0);
    CHECK(patch.point[0].gap == doctest::Approx(-5e-5).epsilon(1e-9));
    CHECK(patch.normal.y() == doctest::Approx(1.0));
}

TEST_CASE("a disc on a rounded box touches at its foot") {
    Scene scene(make_disc(Vec2{0, 0}, 0.01), Pose{0.02, 0.0105, 0});
    add_body(*scene.neighbors, 7, BodyKind::fixed, Pose{0, -0.05, 0},
             {make_box(Vec2{0, 0}, Vec2{0.3, 0.1}, 0.002)});
    scene.detect();
    REQUIRE(scene.patches.count == 1);
    const Patch& patch = scene.patches.patch[0];
    CHECK(patch.point_count == 1);
    CHECK(patch.point[0].gap == doctest::Approx(5e-4).epsilon(1e-9));
    CHECK((patch.point[0].position - Vec2{0.02, 0}).norm() < 1e-15);
}

TEST_CASE("the memory of a patch goes on when bodies change places in the list") {
    Scene scene(make_box(Vec2{0, 0}, Vec2{0.02, 0.01}), Pose{0, 0.0049, 0.0});
    add_body(*scene.neighbors, 7, BodyKind::fixed, Pose{0, -0.05, 0}, {make_box(Vec2{0, 0}, Vec2{0.3, 0.1})});
    scene.detect();
    REQUIRE(scene.patches.count == 1);
    scene.patches.patch[0].memory.state = ContactState::sticking;
    scene.patches.patch[0].memory.slip_spring = 1.25e-5;
    scene.neighbors = make_set();
    add_body(*scene.neighbors, 9, BodyKind::fixed, Pose{1, 1, 0}, {make_disc(Vec2{0, 0}, 0.01)});
    add_body(*scene.neighbors, 7, BodyKind::fixed, Pose{0, -0.05, 0}, {make_box(Vec2{0, 0}, Vec2{0.3, 0.1})});
    scene.detect();
    REQUIRE(scene.patches.count == 1);
    CHECK(scene.patches.patch[0].body_b == 2);
    CHECK(scene.patches.patch[0].memory.state == ContactState::sticking);
    CHECK(scene.patches.patch[0].memory.slip_spring == 1.25e-5);
}

TEST_CASE("fixed bodies are not listed against each other, movable ones are") {
    Scene scene(make_disc(Vec2{0, 0}, 0.01), Pose{1, 1, 0});
    add_body(*scene.neighbors, 1, BodyKind::fixed, Pose{0, 0, 0}, {make_box(Vec2{0, 0}, Vec2{0.1, 0.1})});
    add_body(*scene.neighbors, 2, BodyKind::fixed, Pose{0.05, 0, 0}, {make_box(Vec2{0, 0}, Vec2{0.1, 0.1})});
    add_body(*scene.neighbors, 3, BodyKind::movable, Pose{0, 0.0599, 0},
             {make_box(Vec2{0, 0}, Vec2{0.02, 0.02})});
    scene.detect();
    REQUIRE(scene.patches.count == 1);
    CHECK(scene.patches.patch[0].body_a == 3);
    CHECK(scene.patches.patch[0].point_count == 2);
}

TEST_CASE("a tool far out of a thin wall on the other side still feels the face it came through") {
    Scene scene(make_box(Vec2{0, 0}, Vec2{0.005, 0.005}), Pose{0.01, 0.0035, 0});
    add_body(*scene.neighbors, 7, BodyKind::fixed, Pose{0, 0, 0},
             {make_box(Vec2{0, -0.0005}, Vec2{0.1, 0.001})});
    scene.detect();
    for (int i = 0; i <= 160; ++i) {
        scene.tool->body[0].pose.y() = 0.0025 - 1e-4 * i;
        scene.detect();
        REQUIRE(scene.patches.count == 1);
        CHECK(scene.patches.patch[0].normal.y() == doctest::Approx(1.0));
        CHECK(scene.patches.patch[0].point[0].gap == doctest::Approx(-1e-4 * i).epsilon(1e-9));
    }
}
