#include <haptics/core/contact/detection.hpp>
#include <haptics/core/contact/seams.hpp>
#include <haptics/core/geometry/decompose.hpp>

#include <doctest/doctest.h>

#include <random>

#include "contact_scenes.hpp"

using namespace haptics;
using namespace haptics::testing;

namespace {

using Random = std::mt19937_64;

double uniform(Random& random, double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
}

/// A rectangle from x0 to x1 with its top at 0.
Convex slab(double x0, double x1, double depth, double rounding) {
    return make_box(Vec2{0.5 * (x0 + x1), -0.5 * depth}, Vec2{x1 - x0, depth}, rounding);
}

/// Whole wall: from x0 to x1, top at 0, 20 mm thick.
struct Wall {
    double x0;
    double x1;
    double rounding;
};

std::unique_ptr<BodySet> whole_wall(const Wall& wall, const Pose& at) {
    auto set = make_set();
    add_body(*set, 50, BodyKind::fixed, at, {slab(wall.x0, wall.x1, 0.02, wall.rounding)});
    mark_seams(*set);
    return set;
}

/// The same wall cut anywhere: one or several bodies, abutting or overlapping, extra matter below. The corner
/// pieces are as thick as the wall where the wall is rounded, so that the drawn outline is the same.
std::unique_ptr<BodySet> cut_wall(const Wall& wall, const Pose& at, Random& random, double seam_at) {
    auto set = make_set();
    const int pieces = 2 + static_cast<int>(random() % 6);
    std::vector<double> cut{wall.x0, wall.x1, seam_at};
    for (int i = 2; i < pieces; ++i)
        cut.push_back(uniform(random, wall.x0 + 0.004, wall.x1 - 0.004));
    std::sort(cut.begin(), cut.end());
    const bool overlap = random() % 2 == 0;
    const bool bodies = random() % 2 == 0;
    std::uint64_t id = 100 + random() % 50;
    for (std::size_t i = 0; i + 1 < cut.size(); ++i) {
        if (cut[i + 1] - cut[i] < 1e-6)
            continue;
        double a = cut[i];
        double b = cut[i + 1];
        if (overlap && i > 0)
            a = std::max(wall.x0 + 0.002, a - uniform(random, 0.0, 0.004));
        const bool end = i == 0 || i + 2 == cut.size();
        const double depth = end ? 0.02 : uniform(random, 0.005, 0.02);
        const Convex piece = slab(a, b, depth, wall.rounding);
        if (bodies || set->body_count == 0) {
            // each body has its own origin and turn
            const Pose own{uniform(random, -0.1, 0.1), uniform(random, -0.1, 0.1),
                           uniform(random, -3.0, 3.0)};
            Convex moved = piece;
            std::vector<Vec2> outline;
            const Transform from(at);
            const Transform to(own);
            for (const Vec2& p : {Vec2{a, -depth}, Vec2{b, -depth}, Vec2{b, 0.0}, Vec2{a, 0.0}})
                outline.push_back(to.apply_inverse(from.apply(p)));
            moved = make_convex(outline, wall.rounding);
            if (bodies) {
                add_body(*set, id++, BodyKind::fixed, own, {moved});
                continue;
            }
            add_body(*set, id++, BodyKind::fixed, at, {piece});
            continue;
        }
        Body& body = set->body[0];
        Piece& added = set->piece[static_cast<std::size_t>(set->piece_count++)];
        added = Piece{};
        added.id = static_cast<std::uint32_t>(++body.piece_count);
        added.convex = piece;
    }
    mark_seams(*set);
    return set;
}

std::vector<Convex> tools() {
    return {make_box(Vec2{0, 0}, Vec2{0.02, 0.01}), make_box(Vec2{0, 0}, Vec2{0.02, 0.01}, 0.001),
            make_disc(Vec2{0, 0}, 0.006),
            make_convex(std::array{Vec2{0, -0.008}, Vec2{0.002, 0.008}, Vec2{-0.002, 0.008}}),
            make_capsule(Vec2{-0.01, 0}, Vec2{0.01, 0}, 0.003)};
}

/// Lowest point of a tool at pose height 0.
double lowest(const Convex& tool, double theta) {
    double low = 1.0;
    for (int i = 0; i < tool.count; ++i)
        low = std::min(low, rotate(theta, tool.vertex[static_cast<std::size_t>(i)]).y());
    return low - tool.radius;
}

void check_equal(const PatchList& p, const PatchList& q, double tolerance) {
    REQUIRE(p.count == q.count);
    for (int i = 0; i < p.count; ++i) {
        const Patch& a = p.patch[static_cast<std::size_t>(i)];
        const Patch& b = q.patch[static_cast<std::size_t>(i)];
        CHECK((a.normal - b.normal).norm() < tolerance);
        REQUIRE(a.point_count == b.point_count);
        for (int k = 0; k < a.point_count; ++k) {
            const PatchPoint& s = a.point[static_cast<std::size_t>(k)];
            // either order
            const PatchPoint* t = &b.point[0];
            for (int m = 1; m < b.point_count; ++m)
                if ((b.point[1].position - s.position).norm() < (t->position - s.position).norm())
                    t = &b.point[1];
            CHECK((s.position - t->position).norm() < tolerance);
            CHECK(std::abs(s.gap - t->gap) < tolerance);
            CHECK(std::abs(s.weight - t->weight) < 1e-5);
        }
    }
}

} // namespace

TEST_CASE("a wall cut anywhere into any pieces gives the same patch as the whole wall") {
    Random random(1);
    int seen = 0;
    for (int trial = 0; trial < 4000; ++trial) {
        CAPTURE(trial);
        const auto shapes = tools();
        const Convex& shape = shapes[random() % shapes.size()];
        const Wall wall{-0.05, 0.05, random() % 2 == 0 ? 0.0 : 0.001};
        const Pose at{uniform(random, -0.2, 0.2), uniform(random, -0.2, 0.2), uniform(random, -3.0, 3.0)};
        const double tilt = random() % 3 == 0 ? 0.0 : uniform(random, -0.05, 0.05);
        const double gap = uniform(random, -2e-4, 8e-4);
        const double x = random() % 4 == 0 ? uniform(random, 0.035, 0.052) : uniform(random, -0.04, 0.04);
        const Pose local{x, gap - lowest(shape, tilt), tilt};
        auto tool = make_set();
        const Vec2 origin = Transform(at).apply(local.head<2>());
        add_body(*tool, 0, BodyKind::tool, Pose{origin.x(), origin.y(), at.z() + tilt}, {shape});
        const double seam =
            random() % 2 == 0 ? std::clamp(x + 0.01, -0.046, 0.046) : std::clamp(x, -0.046, 0.046);
        const auto whole = whole_wall(wall, at);
        const auto cut = cut_wall(wall, at, random, seam);
        PatchList p;
        PatchList q;
        const DetectionSettings settings;
        detect_patches(*tool, *whole, settings, p, p);
        detect_patches(*tool, *cut, settings, q, q);
        check_equal(p, q, 2e-9);
        seen += p.count;
    }
    CHECK(seen > 3500);
}

TEST_CASE(
    "sliding over seams gives no lateral normal and keeps the state, at any speed in either direction") {
    Random random(2);
    for (int trial = 0; trial < 200; ++trial) {
        CAPTURE(trial);
        const auto shapes = tools();
        const Convex& shape = shapes[random() % shapes.size()];
        const Wall wall{-0.05, 0.05, random() % 2 == 0 ? 0.0 : 0.001};
        const auto cut = cut_wall(wall, Pose{0, 0, 0}, random, uniform(random, -0.04, 0.04));
        const double speed = uniform(random, 0.01, 5.0) * (random() % 2 == 0 ? 1.0 : -1.0);
        const double depth = std::pow(10.0, uniform(random, -6.0, -2.3));
        const double tilt = random() % 2 == 0 ? 0.0 : uniform(random, -0.02, 0.02);
        auto tool = make_set();
        Body& body = add_body(*tool, 0, BodyKind::tool, Pose{0, 0, tilt}, {shape});
        body.velocity = Twist{speed, 0, 0};
        PatchList patches;
        const DetectionSettings settings;
        double x = speed > 0.0 ? -0.035 : 0.035;
        // come from above
        tool->body[0].pose = Pose{x, 1e-4 - lowest(shape, tilt), tilt};
        detect_patches(*tool, *cut, settings, patches, patches);
        REQUIRE(patches.count == 1);
        patches.patch[0].memory.age = 1;
        while (std::abs(x) < 0.036) {
            tool->body[0].pose = Pose{x, -depth - lowest(shape, tilt), tilt};
            detect_patches(*tool, *cut, settings, patches, patches);
            REQUIRE(patches.count == 1);
            const Patch& patch = patches.patch[0];
            REQUIRE(std::abs(patch.normal.x()) < 1e-9);
            REQUIRE(patch.memory.age >= 1);
            REQUIRE(lowest_gap(patch) == doctest::Approx(-depth).epsilon(1e-6));
            ++patches.patch[0].memory.age;
            x += speed * settings.step;
        }
    }
}

TEST_CASE("a disc goes around the outer corner of two mitred walls as around a whole one") {
    const double r = 0.002;
    auto whole = make_set();
    add_body(*whole, 1, BodyKind::fixed, Pose{0, 0, 0},
             {make_convex(std::array{Vec2{-0.1, -0.1}, Vec2{0, -0.1}, Vec2{0, 0}, Vec2{-0.1, 0}}, r)});
    auto mitred = make_set();
    add_body(*mitred, 1, BodyKind::fixed, Pose{0, 0, 0},
             {make_convex(std::array{Vec2{-0.1, -0.1}, Vec2{0, 0}, Vec2{-0.1, 0}}, r),
              make_convex(std::array{Vec2{-0.1, -0.1}, Vec2{0, -0.1}, Vec2{0, 0}}, r)});
    mark_seams(*mitred);
    auto tool = make_set();
    add_body(*tool, 0, BodyKind::tool, Pose{0, 0, 0}, {make_disc(Vec2{0, 0}, 0.003)});
    for (int i = -200; i <= 200; ++i) {
        const double angle = 0.785398 + i * 0.006;
        tool->body[0].pose = Pose{-r + 0.0052 * std::cos(angle), -r + 0.0052 * std::sin(angle), 0};
        PatchList p;
        PatchList q;
        detect_patches(*tool, *whole, {}, p, p);
        detect_patches(*tool, *mitred, {}, q, q);
        REQUIRE(p.count == 1);
        check_equal(p, q, 1e-9);
    }
}

TEST_CASE("a concave outline cut into pieces is felt as one solid") {
    // a comb with its teeth down: the back is one flat face
    std::vector<Vec2> comb;
    for (int i = 0; i < 12; ++i) {
        const double x = 0.01 * i;
        comb.insert(comb.end(),
                    {Vec2{x, 0}, Vec2{x, -0.02}, Vec2{x + 0.005, -0.02}, Vec2{x + 0.005, -0.001}});
        comb.push_back(Vec2{x + 0.01, -0.001});
        comb.erase(comb.end() - 5);
    }
    comb.push_back(Vec2{0.12, 0});
    comb.insert(comb.begin(), Vec2{0, 0});
    const Decomposition pieces = decompose(comb);
    REQUIRE(pieces.error == OutlineError::none);
    auto set = make_set();
    Body& body = add_body(*set, 1, BodyKind::fixed, Pose{0, 0, 0}, {});
    for (const Convex& convex : pieces.pieces) {
        Piece& piece = set->piece[static_cast<std::size_t>(set->piece_count++)];
        piece.id = static_cast<std::uint32_t>(++body.piece_count);
        piece.convex = convex;
    }
    mark_seams(*set);
    auto tool = make_set();
    add_body(*tool, 0, BodyKind::tool, Pose{0, 0, 0}, {make_box(Vec2{0, 0}, Vec2{0.02, 0.01})});
    PatchList patches;
    for (double x = 0.012; x < 0.108; x += 0.0003) {
        CAPTURE(x);
        tool->body[0].pose = Pose{x, 0.0048, 0};
        detect_patches(*tool, *set, {}, patches, patches);
        REQUIRE(patches.count == 1);
        REQUIRE(std::abs(patches.patch[0].normal.x()) < 1e-12);
        REQUIRE(patches.patch[0].point_count == 2);
        REQUIRE(std::abs(patches.patch[0].point[0].position.x() - patches.patch[0].point[1].position.x()) ==
                doctest::Approx(0.02));
    }
}

TEST_CASE("marking a solid twice, or first each body and then all, changes nothing") {
    Random random(9);
    const Wall wall{-0.05, 0.05, 0.001};
    for (int trial = 0; trial < 50; ++trial) {
        const auto once = cut_wall(wall, Pose{0.1, 0.2, 0.3}, random, 0.001);
        auto twice = std::make_unique<BodySet>(*once);
        mark_seams(*twice);
        for (std::size_t i = 0; i < static_cast<std::size_t>(once->piece_count); ++i) {
            const Convex& p = once->piece[i].convex;
            const Convex& q = twice->piece[i].convex;
            CHECK(p.hidden_edges == q.hidden_edges);
            CHECK(p.ghost_vertices == q.ghost_vertices);
            CHECK(p.blunt_vertices == q.blunt_vertices);
            for (std::size_t k = 0; k < static_cast<std::size_t>(p.count); ++k) {
                CHECK((p.vertex[k] - q.vertex[k]).norm() < 1e-14);
                CHECK(std::abs(p.face_before[k] - q.face_before[k]) < 1e-14);
                CHECK(std::abs(p.face_after[k] - q.face_after[k]) < 1e-14);
            }
        }
    }
}
