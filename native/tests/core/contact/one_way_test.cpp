#include <haptics/core/contact/detection.hpp>

#include <doctest/doctest.h>

#include "contact_scenes.hpp"

using namespace haptics;
using namespace haptics::testing;

namespace {

struct Platform {
    std::unique_ptr<BodySet> tool{make_set()};
    std::unique_ptr<BodySet> set{make_set()};
    PatchList patches;

    Platform() {
        add_body(*set, 1, BodyKind::fixed, Pose{0, 0, 0},
                 {make_box(Vec2{0, -0.002}, Vec2{0.1, 0.004}, 0.001)});
        set->piece[0].one_way = true;
        add_body(*tool, 0, BodyKind::tool, Pose{0, 0, 0}, {make_box(Vec2{0, 0}, Vec2{0.01, 0.01})});
    }
    void at(double x, double y) {
        tool->body[0].pose = Pose{x, y, 0};
        detect_patches(*tool, *set, {}, patches, patches);
    }
};

} // namespace

TEST_CASE("a one-way piece holds what comes from its free side") {
    Platform scene;
    for (int i = -5; i <= 60; ++i) {
        scene.at(0.0, 0.005 - 1e-4 * i);
        REQUIRE(scene.patches.count == 1);
        CHECK(scene.patches.patch[0].normal.y() == doctest::Approx(1.0));
        CHECK(scene.patches.patch[0].point[0].gap == doctest::Approx(-1e-4 * i));
    }
}

TEST_CASE("a one-way piece lets pass what comes from behind or from the side, then holds it") {
    Platform scene;
    for (int i = 0; i < 140; ++i) { // up through it
        scene.at(0.0, -0.0095 + 1e-4 * i);
        if (scene.tool->body[0].pose.y() < 0.005 - 1e-5)
            REQUIRE(scene.patches.count == 0);
    }
    scene.at(0.0, 0.0051);
    for (int i = 0; i < 20; ++i)
        scene.at(0.0, 0.005 - 1e-4 * i);
    REQUIRE(scene.patches.count == 1);
    CHECK(scene.patches.patch[0].normal.y() == doctest::Approx(1.0));

    Platform other;
    for (int i = 0; i < 1200; ++i) { // across it from the left
        other.at(-0.06 + 1e-4 * i, -0.002);
        REQUIRE(other.patches.count == 0);
    }
}
