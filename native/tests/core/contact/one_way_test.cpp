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

namespace {

/// An ordinary floor whose top is at y = 0, and one-way pieces on or above it.
struct Ledge {
    std::unique_ptr<BodySet> tool{make_set()};
    std::unique_ptr<BodySet> set{make_set()};
    PatchList patches;

    Ledge() { add_body(*tool, 0, BodyKind::tool, Pose{0, 0, 0}, {make_box(Vec2{0, 0}, Vec2{0.01, 0.01})}); }
    void add(BodyKind kind, const Vec2& center, const Vec2& size, bool one_way) {
        const auto id = static_cast<std::uint64_t>(set->body_count + 1);
        const auto piece = static_cast<std::size_t>(set->piece_count);
        add_body(*set, id, kind, Pose{center.x(), center.y(), 0}, {make_box(Vec2{0, 0}, size)});
        set->piece[piece].one_way = one_way;
    }
    void at(double x, double y) {
        tool->body[0].pose = Pose{x, y, 0};
        detect_patches(*tool, *set, {}, patches, patches);
    }
    /// How far the tool reaches below the top of a surface it touches, m; negative when it touches none.
    [[nodiscard]] double depth() const {
        double deepest = -1.0;
        for (int i = 0; i < patches.count; ++i)
            deepest = std::max(deepest, -lowest_gap(patches.patch[static_cast<std::size_t>(i)]));
        return deepest;
    }
};

} // namespace

TEST_CASE("what stands on a floor inside of a one-way piece is not caught by it when it rises") {
    for (const double top : {0.0002, 0.0008, 0.002, 0.0028}) {
        Ledge scene;
        scene.add(BodyKind::fixed, Vec2{0, -0.005}, Vec2{0.1, 0.01}, false);
        scene.add(BodyKind::fixed, Vec2{0, top - 0.005}, Vec2{0.1, 0.01}, true);
        for (int i = 0; i < 20; ++i)
            scene.at(0.0, 0.0049); // on the floor, 0.1 mm deep
        for (int i = 0; i < 100; ++i) {
            const double bottom = -1e-4 + 4e-5 * i;
            scene.at(0.0, 0.005 + bottom);
            if (bottom < top - 1e-5)
                REQUIRE(scene.depth() <= std::max(-bottom, 0.0) + 1e-9);
        }
    }
}

TEST_CASE("a row of one-way pieces holds what slides along it, and so does one beside a floor") {
    for (const bool floor_first : {false, true}) {
        Ledge scene;
        for (int i = 0; i < 6; ++i)
            scene.add(BodyKind::fixed, Vec2{0.02 * i, -0.005}, Vec2{0.02, 0.01}, i > 0 || !floor_first);
        for (int i = 10; i >= -1; --i)
            scene.at(0.0, 0.005 + 1e-4 * i);
        for (int i = 0; i < 1000; ++i) {
            scene.at(1e-4 * i, 0.0049);
            int touching = 0;
            for (int k = 0; k < scene.patches.count; ++k)
                touching += lowest_gap(scene.patches.patch[static_cast<std::size_t>(k)]) <= 0.0 ? 1 : 0;
            REQUIRE(touching == 1);
            REQUIRE(scene.depth() == doctest::Approx(1e-4));
        }
    }
}

TEST_CASE("what lies on a low one-way piece is not caught by a higher one beside it") {
    Ledge scene;
    scene.add(BodyKind::fixed, Vec2{0.0, -0.005}, Vec2{0.02, 0.01}, true);
    scene.add(BodyKind::fixed, Vec2{0.02, -0.003}, Vec2{0.02, 0.01}, true); // 2 mm higher
    for (int i = 10; i >= -1; --i)
        scene.at(-0.005, 0.005 + 1e-4 * i);
    for (int i = 0; i < 300; ++i) {
        scene.at(-0.005 + 1e-4 * i, 0.0049);
        REQUIRE(scene.depth() <= 1.0001e-4);
    }
}

TEST_CASE("a one-way piece goes on holding over updates that move, reorder and rename its neighbors") {
    Ledge scene;
    scene.add(BodyKind::kinematic, Vec2{0.0, -0.005}, Vec2{0.1, 0.01}, true);
    for (int i = 10; i >= -1; --i)
        scene.at(0.0, 0.005 + 1e-4 * i);
    for (int update = 0; update < 50; ++update) {
        // the platform sinks, others come and go before and behind it in the list
        auto next = make_set();
        if (update % 3 == 0)
            add_body(*next, 100 + static_cast<std::uint64_t>(update), BodyKind::fixed, Pose{1, 1, 0},
                     {make_box(Vec2{0, 0}, Vec2{0.01, 0.01})});
        const auto piece = static_cast<std::size_t>(next->piece_count);
        add_body(*next, 1, BodyKind::kinematic, Pose{0, -0.005 - 1e-4 * update, 0},
                 {make_box(Vec2{0, 0}, Vec2{0.1, 0.01})});
        next->piece[piece].one_way = true;
        scene.set = std::move(next);
        scene.at(0.0, 0.0049 - 1e-4 * update);
        REQUIRE(scene.patches.count == 1);
        REQUIRE(scene.depth() == doctest::Approx(1e-4));
    }
}
