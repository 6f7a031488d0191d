#include <haptics/core/contact/detection.hpp>
#include <haptics/core/contact/seams.hpp>
#include <haptics/core/contact/time_of_impact.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <random>

#include "contact_scenes.hpp"
#include "support/allocation_guard.hpp"

using namespace haptics;
using namespace haptics::testing;

namespace {

using Random = std::mt19937_64;

double uniform_draw(Random& random, double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
}

/// A room of four overlapping walls with a disc, a box that can be pushed and a two-piece post.
void fill_room(BodySet& set) {
    add_body(set, 11, BodyKind::fixed, Pose{0, -0.06, 0}, {make_box(Vec2{0, 0}, Vec2{0.24, 0.02}, 0.0005)});
    add_body(set, 12, BodyKind::fixed, Pose{0, 0.06, 0}, {make_box(Vec2{0, 0}, Vec2{0.24, 0.02}, 0.0005)});
    add_body(set, 13, BodyKind::fixed, Pose{-0.11, 0, 0}, {make_box(Vec2{0, 0}, Vec2{0.02, 0.14}, 0.0005)});
    add_body(set, 14, BodyKind::fixed, Pose{0.11, 0, 0}, {make_box(Vec2{0, 0}, Vec2{0.02, 0.14}, 0.0005)});
    add_body(set, 15, BodyKind::kinematic, Pose{0.05, 0.02, 0}, {make_disc(Vec2{0, 0}, 0.01)}).velocity =
        Twist{0.1, 0, 1};
    add_body(set, 16, BodyKind::movable, Pose{0.02, -0.0401, 0}, {make_box(Vec2{0, 0}, Vec2{0.02, 0.02})});
    add_body(set, 17, BodyKind::movable, Pose{0.0399, -0.0401, 0}, {make_box(Vec2{0, 0}, Vec2{0.02, 0.02})});
    add_body(set, 18, BodyKind::fixed, Pose{-0.05, -0.04, 0},
             {make_box(Vec2{-0.005, 0}, Vec2{0.01, 0.02}), make_box(Vec2{0.005, 0}, Vec2{0.01, 0.02})});
}

/// The same bodies in another order, pieces too.
void shuffle(const BodySet& from, BodySet& to, Random& random) {
    std::vector<int> order;
    for (int i = 0; i < from.body_count; ++i)
        order.push_back(i);
    std::shuffle(order.begin(), order.end(), random);
    to.body_count = 0;
    to.piece_count = 0;
    for (const int i : order) {
        Body& body = to.body[static_cast<std::size_t>(to.body_count++)];
        body = from.body[static_cast<std::size_t>(i)];
        const std::int32_t first = body.first_piece;
        body.first_piece = to.piece_count;
        for (std::int32_t k = body.piece_count - 1; k >= 0; --k)
            to.piece[static_cast<std::size_t>(to.piece_count++)] =
                from.piece[static_cast<std::size_t>(first + k)];
    }
}

std::unique_ptr<BodySet> random_tool(Random& random) {
    auto tool = make_set();
    Convex shape = make_box(Vec2{0, 0}, Vec2{0.03, 0.02}, random() % 2 == 0 ? 0.0 : 0.001);
    if (random() % 3 == 0)
        shape = make_disc(Vec2{0, 0}, 0.01);
    Body& body = add_body(
        *tool, 0, BodyKind::tool,
        Pose{uniform_draw(random, -0.1, 0.1), uniform_draw(random, -0.05, 0.05), uniform_draw(random, -3, 3)},
        {shape});
    if (random() % 3 == 0)
        body.pose.z() = 0.0;
    body.velocity =
        Twist{uniform_draw(random, -2, 2), uniform_draw(random, -2, 2), uniform_draw(random, -10, 10)};
    return tool;
}

bool same_bits(const Patch& p, const Patch& q) {
    const auto same = [](const Vec2& a, const Vec2& b) {
        return std::bit_cast<std::uint64_t>(a.x()) == std::bit_cast<std::uint64_t>(b.x()) &&
               std::bit_cast<std::uint64_t>(a.y()) == std::bit_cast<std::uint64_t>(b.y());
    };
    bool equal = p.feature_a == q.feature_a && p.feature_b == q.feature_b && same(p.normal, q.normal) &&
                 p.point_count == q.point_count;
    for (int i = 0; equal && i < p.point_count; ++i) {
        const auto k = static_cast<std::size_t>(i);
        equal = same(p.point[k].position, q.point[k].position) && p.point[k].gap == q.point[k].gap &&
                p.point[k].weight == q.point[k].weight;
    }
    return equal;
}

} // namespace

TEST_CASE("detection gives the same bits when it is repeated") {
    Random random(11);
    auto set = make_set();
    fill_room(*set);
    mark_seams(*set);
    for (int trial = 0; trial < 300; ++trial) {
        const auto tool = random_tool(random);
        PatchList p;
        PatchList q;
        detect_patches(*tool, *set, {}, PatchList{}, p);
        detect_patches(*tool, *set, {}, PatchList{}, q);
        REQUIRE(p.count == q.count);
        for (std::size_t i = 0; i < static_cast<std::size_t>(p.count); ++i)
            REQUIRE(same_bits(p.patch[i], q.patch[i]));
    }
}

TEST_CASE("the order of bodies and pieces in the sets does not change the patches or their order") {
    Random random(12);
    auto set = make_set();
    fill_room(*set);
    mark_seams(*set);
    auto mixed = make_set();
    int seen = 0;
    for (int trial = 0; trial < 500; ++trial) {
        CAPTURE(trial);
        const auto tool = random_tool(random);
        shuffle(*set, *mixed, random);
        PatchList p;
        PatchList q;
        detect_patches(*tool, *set, {}, PatchList{}, p);
        detect_patches(*tool, *mixed, {}, PatchList{}, q);
        REQUIRE(p.count == q.count);
        for (std::size_t i = 0; i < static_cast<std::size_t>(p.count); ++i) {
            const Patch& a = p.patch[i];
            const Patch& b = q.patch[i];
            CHECK(a.feature_a == b.feature_a);
            CHECK(a.feature_b == b.feature_b);
            CHECK((a.normal - b.normal).norm() < 1e-12);
            REQUIRE(a.point_count == b.point_count);
            CHECK(a.side.id_b == b.side.id_b);
            CHECK(mixed->body[static_cast<std::size_t>(b.body_b - 1)].id == a.side.id_b);
        }
        seen += p.count;
    }
    CHECK(seen > 1000);
}

TEST_CASE("the state goes on from a face to a corner and back, and from one end to the other") {
    auto tool = make_set();
    auto set = make_set();
    add_body(*tool, 0, BodyKind::tool, Pose{0, 0, 0}, {make_box(Vec2{0, 0}, Vec2{0.02, 0.01})});
    add_body(*set, 1, BodyKind::fixed, Pose{0, -0.01, 0}, {make_box(Vec2{0, 0}, Vec2{0.2, 0.02})});
    PatchList patches;
    for (int i = 0; i <= 2000; ++i) {
        const double tilt = 0.2 * std::sin(0.01 * i);
        const double low = -0.01 * std::abs(std::sin(tilt)) - 0.005 * std::cos(tilt);
        tool->body[0].pose = Pose{1e-5 * i, -5e-5 - low, tilt};
        detect_patches(*tool, *set, {}, patches, patches);
        REQUIRE(patches.count == 1);
        REQUIRE(patches.patch[0].memory.age == static_cast<std::uint32_t>(i));
        patches.patch[0].memory.age = static_cast<std::uint32_t>(i + 1);
    }
}

TEST_CASE("a disc that rolls along a floor of many bodies keeps its state") {
    auto tool = make_set();
    auto set = make_set();
    add_body(*tool, 0, BodyKind::tool, Pose{0, 0, 0}, {make_disc(Vec2{0, 0}, 0.005)});
    for (int i = 0; i < 40; ++i)
        add_body(*set, static_cast<std::uint64_t>(100 - i), BodyKind::fixed,
                 Pose{-0.1 + 0.005 * (i + 0.5), -0.01, 0}, {make_box(Vec2{0, 0}, Vec2{0.005, 0.02}, 0.0005)});
    mark_seams(*set);
    PatchList patches;
    for (int i = 0; i < 1800; ++i) {
        const double x = -0.09 + 1e-4 * i;
        tool->body[0].pose = Pose{x, 0.005 - 1e-4, -x / 0.005};
        detect_patches(*tool, *set, {}, patches, patches);
        REQUIRE(patches.count == 1);
        REQUIRE(patches.patch[0].memory.age == static_cast<std::uint32_t>(i));
        REQUIRE(patches.patch[0].normal.y() == doctest::Approx(1.0));
        patches.patch[0].memory.age = static_cast<std::uint32_t>(i + 1);
    }
}

TEST_CASE("a new geometry under the same ids, in another order, moves no state") {
    Random random(13);
    auto set = make_set();
    auto mixed = make_set();
    fill_room(*set);
    mark_seams(*set);
    auto tool = make_set();
    // in a corner of the room: two patches
    add_body(*tool, 0, BodyKind::tool, Pose{-0.0851, -0.0401, 0},
             {make_box(Vec2{0, 0}, Vec2{0.03, 0.02}, 0.0005)});
    PatchList patches;
    detect_patches(*tool, *set, {}, patches, patches);
    int corner = 0;
    for (std::size_t i = 0; i < static_cast<std::size_t>(patches.count); ++i) {
        patches.patch[i].memory.slip_spring = 1e-6 * static_cast<double>(i + 1);
        corner += patches.patch[i].side.tool_a ? 1 : 0;
    }
    REQUIRE(corner == 2);
    PatchList before = patches;
    for (int update = 0; update < 200; ++update) {
        shuffle(*set, *mixed, random);
        detect_patches(*tool, *mixed, {}, patches, patches);
        REQUIRE(patches.count == before.count);
        for (std::size_t i = 0; i < static_cast<std::size_t>(patches.count); ++i) {
            REQUIRE(patches.patch[i].memory.slip_spring == before.patch[i].memory.slip_spring);
            REQUIRE(patches.patch[i].side.id_b == before.patch[i].side.id_b);
        }
    }
}

TEST_CASE(
    "a wandering tool in a room of overlapping walls feels only the four inner faces and what stands in it") {
    Random random(14);
    auto set = make_set();
    fill_room(*set);
    set->body_count = 4;
    mark_seams(*set);
    for (int run = 0; run < 40; ++run) {
        CAPTURE(run);
        auto tool = make_set();
        add_body(*tool, 0, BodyKind::tool, Pose{0, 0, 0},
                 {run % 2 == 0 ? make_box(Vec2{0, 0}, Vec2{0.03, 0.02}) : make_disc(Vec2{0, 0}, 0.01)});
        PatchList patches;
        Pose pose{uniform_draw(random, -0.06, 0.06), uniform_draw(random, -0.02, 0.02), 0};
        Twist twist{0, 0, 0};
        for (int i = 0; i < 3000; ++i) {
            if (i % 100 == 0)
                twist = Twist{uniform_draw(random, -0.5, 0.5), uniform_draw(random, -0.5, 0.5),
                              uniform_draw(random, -5, 5)};
            Body& body = tool->body[0];
            body.pose = pose;
            body.velocity = twist;
            detect_patches(*tool, *set, {}, patches, patches);
            for (int k = 0; k < patches.count; ++k) {
                const Patch& patch = patches.patch[static_cast<std::size_t>(k)];
                const double low = lowest_gap(patch);
                REQUIRE(std::max(std::abs(patch.normal.x()), std::abs(patch.normal.y())) ==
                        doctest::Approx(1.0));
                REQUIRE(low > -0.003);
                // into the room
                const Vec2 inward = -patch.point[0].position;
                REQUIRE(patch.normal.dot(inward) > 0.03);
                // a stiff wall
                if (low < 0.0)
                    pose.head<2>() += 0.5 * -low * patch.normal;
            }
            REQUIRE(patches.count <= 4);
            pose += 0.001 * twist;
        }
    }
}

TEST_CASE("detection and time of impact take nothing from the heap") {
    Random random(15);
    auto set = make_set();
    fill_room(*set);
    mark_seams(*set);
    auto cache = std::make_unique<BodyCache>();
    auto tool_cache = std::make_unique<BodyCache>();
    PatchList patches;
    for (int trial = 0; trial < 100; ++trial) {
        const auto tool = random_tool(random);
        const AllocationGuard guard;
        tool_cache->known = false;
        detect_patches(*tool, *tool_cache, *set, *cache, {}, patches, patches);
        for (std::size_t i = 0; i < static_cast<std::size_t>(patches.count); ++i)
            (void)time_of_impact(*tool, *set, patches.patch[i], Twist{0.1, -0.2, 3}, Twist{0, 0, 0}, 0.001);
        CHECK(guard.allocations() == 0);
        CHECK(guard.deallocations() == 0);
    }
}

TEST_CASE("when there are more patches than room the deepest stay and the rest is counted") {
    auto tool = make_set();
    auto set = make_set();
    add_body(*tool, 0, BodyKind::tool, Pose{0, 0, 0}, {make_disc(Vec2{0, 0}, 0.05)});
    for (int i = 0; i < 100; ++i) {
        const double angle = 2.0 * 3.14159265 * i / 100;
        const double depth = 1e-6 * (1 + (i * 37) % 100);
        add_body(*set, static_cast<std::uint64_t>(i + 1), BodyKind::fixed,
                 Pose{(0.052 - depth) * std::cos(angle), (0.052 - depth) * std::sin(angle), 0},
                 {make_disc(Vec2{0, 0}, 0.002)});
    }
    // one disc a surface of its own, so that nothing merges
    for (std::int32_t i = 0; i < set->body_count; ++i)
        set->body[static_cast<std::size_t>(i)].surface.stiffness = 1000.0 + i;
    PatchList patches;
    detect_patches(*tool, *set, {}, patches, patches);
    CHECK(patches.count == k_max_patches);
    CHECK(patches.overflow == 36);
    for (std::size_t i = 0; i < static_cast<std::size_t>(patches.count); ++i)
        CHECK(patches.patch[i].point[0].gap < -36.5e-6);
}
