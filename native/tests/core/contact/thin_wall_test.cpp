#include <haptics/core/contact/detection.hpp>
#include <haptics/core/contact/seams.hpp>

#include <doctest/doctest.h>

#include <random>

#include "contact_scenes.hpp"

using namespace haptics;
using namespace haptics::testing;

namespace {

std::vector<Convex> thin_wall_tools() {
    return {make_box(Vec2{0, 0}, Vec2{0.005, 0.005}),
            make_box(Vec2{0, 0}, Vec2{0.02, 0.02}),
            make_box(Vec2{0, 0}, Vec2{0.02, 0.02}, 0.002),
            make_disc(Vec2{0, 0}, 0.002),
            make_disc(Vec2{0, 0}, 0.01),
            make_capsule(Vec2{-0.005, 0}, Vec2{0.005, 0.001}, 0.001),
            make_convex(std::array{Vec2{0, -0.01}, Vec2{0.003, 0.01}, Vec2{-0.003, 0.01}})};
}

double lowest_corner(const Convex& tool, double theta) {
    double low = 1.0;
    for (int i = 0; i < tool.count; ++i)
        low = std::min(low, rotate(theta, tool.vertex[static_cast<std::size_t>(i)]).y());
    return low - tool.radius;
}

/// A wall of 1 mm with its top at 0: a box, a rounded box, a capsule, a bare segment, and three pieces.
std::unique_ptr<BodySet> thin_wall(int kind) {
    auto set = make_set();
    const Pose at{0, 0, 0};
    const Vec2 middle{0, -0.0005};
    if (kind == 0)
        add_body(*set, 1, BodyKind::fixed, at, {make_box(middle, Vec2{0.1, 0.001})});
    else if (kind == 1)
        add_body(*set, 1, BodyKind::fixed, at, {make_box(middle, Vec2{0.1, 0.001}, 0.0003)});
    else if (kind == 2)
        add_body(*set, 1, BodyKind::fixed, at,
                 {make_capsule(Vec2{-0.05, -0.0005}, Vec2{0.05, -0.0005}, 0.0005)});
    else if (kind == 3)
        add_body(*set, 1, BodyKind::fixed, at, {make_segment(Vec2{-0.05, 0}, Vec2{0.05, 0})});
    else
        for (int i = 0; i < 3; ++i)
            add_body(*set, static_cast<std::uint64_t>(1 + i), BodyKind::fixed, at,
                     {make_box(Vec2{-0.05 + (i + 0.5) * 0.1 / 3, -0.0005}, Vec2{0.1 / 3, 0.001})});
    mark_seams(*set);
    return set;
}

} // namespace

TEST_CASE(
    "16 mm deep in a wall of 1 mm a tool feels the face it came through, wherever it slides and turns") {
    std::mt19937_64 random(8);
    for (int kind = 0; kind < 5; ++kind) {
        const auto set = thin_wall(kind);
        for (const Convex& shape : thin_wall_tools()) {
            for (int run = 0; run < 6; ++run) {
                CAPTURE(kind);
                CAPTURE(shape.count);
                CAPTURE(shape.radius);
                CAPTURE(run);
                auto tool = make_set();
                add_body(*tool, 0, BodyKind::tool, Pose{0, 0, 0}, {shape});
                PatchList patches;
                std::uniform_real_distribution<double> start(-0.03, 0.03);
                double x = start(random);
                double theta = run % 2 == 0 ? 0.0 : 0.1;
                for (int i = -8; i <= 500; ++i) {
                    CAPTURE(i);
                    // in to 16 mm, then sideways and back, then turn a little
                    const double depth = std::min(0.016, 1e-4 * i);
                    if (i > 170 && i <= 300)
                        x += x > 0.0 ? -2e-4 : 2e-4;
                    if (i > 300)
                        theta += 2e-4;
                    tool->body[0].pose = Pose{x, -depth - lowest_corner(shape, theta), theta};
                    detect_patches(*tool, *set, {}, patches, patches);
                    REQUIRE(patches.count == 1);
                    const Patch& patch = patches.patch[0];
                    REQUIRE(patch.normal.y() > 0.98);
                    const double low = lowest_gap(patch);
                    if (i > 0)
                        REQUIRE(low < -0.5 * depth);
                    if (i <= 300)
                        REQUIRE(low == doctest::Approx(-depth).epsilon(0.02).scale(1e-3));
                    if (i > -8)
                        REQUIRE(patch.memory.age > 0);
                    patches.patch[0].memory.age = 1;
                }
            }
        }
    }
}

TEST_CASE(
    "the side is given up over the face or beyond the wall's end, and then the other side can be felt") {
    const auto set = thin_wall(0);
    auto tool = make_set();
    add_body(*tool, 0, BodyKind::tool, Pose{0, 0.003, 0}, {make_disc(Vec2{0, 0}, 0.002)});
    PatchList patches;
    const auto at = [&](double x, double y) {
        tool->body[0].pose = Pose{x, y, 0};
        detect_patches(*tool, *set, {}, patches, patches);
    };
    at(0.04, 0.0025);
    for (int i = 0; i < 100; ++i)
        at(0.04, 0.002 - 1e-4 * i);
    REQUIRE(patches.count == 1);
    CHECK(patches.patch[0].normal.y() == doctest::Approx(1.0));
    // beyond the end
    for (int i = 0; i < 200; ++i)
        at(0.04 + 1e-4 * i, -0.008);
    CHECK(patches.count == 0);
    // up from below
    for (int i = 0; i < 200; ++i)
        at(0.06 - 1e-4 * i, -0.008);
    for (int i = 0; i < 52; ++i)
        at(0.04, -0.008 + 1e-4 * i);
    REQUIRE(patches.count == 1);
    CHECK(patches.patch[0].normal.y() == doctest::Approx(-1.0));
    CHECK(patches.patch[0].point[0].gap == doctest::Approx(-1e-4).epsilon(1e-6));
}

TEST_CASE("a tool that is put into a wall is pushed out the shortest way, through no seam") {
    auto set = make_set();
    for (int i = 0; i < 4; ++i)
        add_body(*set, static_cast<std::uint64_t>(1 + i), BodyKind::fixed, Pose{0, 0, 0},
                 {make_box(Vec2{0.01 * i, -0.02}, Vec2{0.01, 0.04})});
    mark_seams(*set);
    auto tool = make_set();
    add_body(*tool, 0, BodyKind::tool, Pose{0.0151, -0.003, 0}, {make_box(Vec2{0, 0}, Vec2{0.002, 0.002})});
    PatchList patches;
    detect_patches(*tool, *set, {}, patches, patches);
    REQUIRE(patches.count == 1);
    CHECK(patches.patch[0].normal.y() == doctest::Approx(1.0));
    CHECK(patches.patch[0].point[0].gap == doctest::Approx(-0.004));
}

TEST_CASE("a thin blade pressed 16 mm deep over a post feels the post through its own lower face") {
    auto set = make_set();
    add_body(*set, 1, BodyKind::fixed, Pose{0, -0.05, 0}, {make_box(Vec2{0, 0}, Vec2{0.002, 0.1}, 0.0003)});
    for (const double tilt : {0.0, 0.3, -0.3}) {
        auto tool = make_set();
        add_body(*tool, 0, BodyKind::tool, Pose{0, 0, 0}, {make_box(Vec2{0, 0}, Vec2{0.04, 0.001})});
        const Vec2 along = rotate(tilt, Vec2{1, 0});
        const Vec2 up = perpendicular(along);
        PatchList patches;
        for (int i = -5; i <= 160; ++i) {
            CAPTURE(tilt);
            CAPTURE(i);
            // the post is 15 mm from the middle of the blade
            const Vec2 center = 0.015 * along + (0.0005 - 1e-4 * i) * up;
            tool->body[0].pose = Pose{center.x(), center.y(), tilt};
            detect_patches(*tool, *set, {}, patches, patches);
            REQUIRE(patches.count == 1);
            const Patch& patch = patches.patch[0];
            REQUIRE(patch.normal.dot(up) > 0.999);
            REQUIRE(lowest_gap(patch) <= -1e-4 * i + 5e-4);
            REQUIRE(lowest_gap(patch) >= -1e-4 * i - 5e-4);
        }
    }
}
