#include <haptics/core/contact/detection.hpp>

#include <doctest/doctest.h>

#include <numbers>

#include "contact_scenes.hpp"

using namespace haptics;
using namespace haptics::testing;

namespace {

double angle_between(const Vec2& a, const Vec2& b) {
    return std::abs(std::atan2(cross(a, b), a.dot(b)));
}

} // namespace

TEST_CASE("around a rounded corner the normal turns by at most motion over radius, and the patch goes on") {
    const double r = 0.002;
    auto set = make_set();
    add_body(*set, 1, BodyKind::fixed, Pose{0, 0, 0.4}, {make_box(Vec2{0, 0}, Vec2{0.1, 0.06}, r)});
    for (const Convex& shape :
         {make_disc(Vec2{0, 0}, 0.004), make_box(Vec2{0, 0}, Vec2{0.01, 0.006}, 0.001)}) {
        auto tool = make_set();
        add_body(*tool, 0, BodyKind::tool, Pose{0, 0, 0}, {shape});
        PatchList patches;
        Vec2 last{0, 0};
        Vec2 center{0, 0};
        // push the tool along the outline: step sideways, then back to a depth of 0.1 mm
        Pose pose{0.02, 0.06, 0.1};
        double turned = 0.0;
        for (int i = 0; i < 12000; ++i) {
            tool->body[0].pose = pose;
            DetectionSettings settings;
            settings.margin = 0.1;
            detect_patches(*tool, *set, settings, patches, patches);
            REQUIRE(patches.count == 1);
            Patch& patch = patches.patch[0];
            const double low = lowest_gap(patch);
            if (i > 20) {
                const double motion = (pose.head<2>() - center).norm();
                const double turn = angle_between(last, patch.normal);
                REQUIRE(turn <= 1.05 * motion / (r - 0.0001) + 1e-9);
                turned += turn;
                REQUIRE(patch.memory.age == static_cast<std::uint32_t>(i));
            }
            patch.memory.age = static_cast<std::uint32_t>(i + 1);
            last = patch.normal;
            center = pose.head<2>();
            pose.head<2>() += -(low + 1e-4) * patch.normal + 2e-5 * perpendicular(-patch.normal);
        }
        CHECK(turned > std::numbers::pi);
    }
}

TEST_CASE("a box that tilts from its face onto its corner changes gaps, shares and normals without a jump") {
    auto set = make_set();
    add_body(*set, 1, BodyKind::fixed, Pose{0, -0.05, 0}, {make_box(Vec2{0, 0}, Vec2{0.4, 0.1})});
    auto tool = make_set();
    add_body(*tool, 0, BodyKind::tool, Pose{0, 0, 0}, {make_box(Vec2{0, 0}, Vec2{0.02, 0.01})});
    PatchList patches;
    double last_force = 0.0;
    for (int i = -4000; i <= 4000; ++i) {
        const double tilt = i * 1e-5;
        const double low = -0.01 * std::abs(std::sin(tilt)) - 0.005 * std::cos(tilt);
        tool->body[0].pose = Pose{0, -1e-4 - low, tilt};
        detect_patches(*tool, *set, {}, patches, patches);
        REQUIRE(patches.count == 1);
        const Patch& patch = patches.patch[0];
        CHECK(patch.normal.y() == doctest::Approx(1.0));
        double force = 0.0;
        double shares = 0.0;
        for (int k = 0; k < patch.point_count; ++k) {
            const PatchPoint& point = patch.point[static_cast<std::size_t>(k)];
            force += point.weight * std::max(0.0, -point.gap);
            shares += point.weight;
        }
        REQUIRE(shares == doctest::Approx(1.0));
        if (i > -4000)
            REQUIRE(std::abs(force - last_force) < 2e-7);
        last_force = force;
        if (i == 0 || std::abs(tilt) > 0.02)
            REQUIRE(force == doctest::Approx(1e-4)); // level, or on one corner: the wall's full stiffness
    }
}

TEST_CASE("a blade on the corner of a post feels its own face") {
    auto tool = make_set();
    add_body(*tool, 0, BodyKind::tool, Pose{0, 0, 0}, {make_box(Vec2{0, 0}, Vec2{0.08, 0.004})});
    auto set = make_set();
    add_body(*set, 1, BodyKind::fixed, Pose{0, -0.01, 0}, {make_box(Vec2{0, 0}, Vec2{0.01, 0.02})});
    PatchList patches;
    Vec2 last{0, 1};
    for (int i = -3000; i <= 3000; ++i) {
        const double tilt = 1e-4 * i;
        // rest 0.05 mm deep on the higher corner
        const Vec2 corner{i < 0 ? -0.005 : 0.005, 0.0};
        const Vec2 up = rotate(tilt, Vec2{0, 1});
        const Vec2 corner_other{-corner.x(), 0.0};
        const Vec2 support = up.dot(corner) > up.dot(corner_other) ? corner : corner_other;
        const Vec2 center = support + (0.002 - 5e-5) * up;
        tool->body[0].pose = Pose{center.x(), center.y(), tilt};
        detect_patches(*tool, *set, {}, patches, patches);
        REQUIRE(patches.count == 1);
        REQUIRE(angle_between(patches.patch[0].normal, up) <
                0.011); // deepest of the two sides, nearly parallel
        if (i > -3000)
            REQUIRE(angle_between(patches.patch[0].normal, last) < 0.012);
        last = patches.patch[0].normal;
    }
}
