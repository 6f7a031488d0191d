#include <haptics/core/geometry/shapes.hpp>
#include <haptics/core/local_model/select_near.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <memory>
#include <support/random.hpp>
#include <vector>

using namespace haptics;

namespace {

/// Bodies with small boxes at given places (body axes).
struct Pieces {
    std::vector<std::unique_ptr<std::vector<Piece>>> pieces;
    std::vector<std::unique_ptr<std::vector<PieceBounds>>> bounds;
    std::vector<Candidate> candidates;
    std::unique_ptr<BodySet> out{std::make_unique<BodySet>()};

    void add(BodyKind kind, const Pose& pose, const std::vector<Vec2>& places) {
        auto own = std::make_unique<std::vector<Piece>>();
        auto boxes = std::make_unique<std::vector<PieceBounds>>();
        for (const Vec2& place : places) {
            Piece piece;
            piece.id = static_cast<std::uint32_t>(own->size() + 1);
            piece.convex = make_box(place, Vec2(0.002, 0.002));
            own->push_back(piece);
            boxes->push_back(bounds_of(piece.convex));
        }
        Body body;
        body.id = candidates.size() + 1;
        body.kind = kind;
        body.pose = pose;
        candidates.push_back({body, *own, *boxes});
        pieces.push_back(std::move(own));
        bounds.push_back(std::move(boxes));
    }
    LeftOut select(const std::vector<ReachDisc>& discs) { return select_near(candidates, discs, *out); }
};

std::vector<Vec2> row(int count, double pitch) {
    std::vector<Vec2> places;
    for (int i = 0; i < count; ++i)
        places.emplace_back(pitch * i, 0.0);
    return places;
}

} // namespace

TEST_SUITE("select_near") {
    TEST_CASE("of a long body only the pieces within the disc come, also when it is turned and moved") {
        const double pi = std::acos(-1.0);
        Pieces scene;
        scene.add(BodyKind::fixed, Pose(0, 0, 0), row(1000, 0.01));
        scene.add(BodyKind::kinematic, Pose(1.0, 0.5, 0.5 * pi), row(1000, 0.01)); // upward from (1, 0.5)
        const LeftOut left = scene.select({{Vec2(1.0, 0.0), 0.0305}, {Vec2(1.0, 1.0), 0.0205}});
        CHECK(left.bodies == 0);
        CHECK(left.pieces == 0);
        REQUIRE(scene.out->body_count == 2);
        // boxes reach out by 1 mm: 3 to either side of the middle one, 2 in the second row
        CHECK(scene.out->body[0].piece_count == 7);
        CHECK(scene.out->piece[0].id == 98);
        CHECK(scene.out->body[1].first_piece == 7);
        CHECK(scene.out->body[1].piece_count == 5);
        CHECK(scene.out->piece[7].id == 49);
    }

    TEST_CASE("a movable body comes whole or not at all") {
        Pieces scene;
        scene.add(BodyKind::movable, Pose(0, 0, 0), row(10, 0.01));
        scene.add(BodyKind::movable, Pose(0, 1, 0), row(10, 0.01));
        scene.select({{Vec2(0, 0), 0.02}});
        REQUIRE(scene.out->body_count == 1);
        CHECK(scene.out->body[0].id == 1);
        CHECK(scene.out->body[0].piece_count == 10);
    }

    TEST_CASE("a half-plane is everywhere, and without discs everything is near") {
        Pieces scene;
        scene.add(BodyKind::fixed, Pose(0, 0, 0), row(3, 5.0));
        (*scene.pieces[0])[2].convex = make_half_plane(Vec2(0, 0), Vec2(0, 1));
        (*scene.bounds[0])[2] = bounds_of((*scene.pieces[0])[2].convex);
        scene.select({{Vec2(100, 100), 0.01}});
        CHECK(scene.out->piece_count == 1);
        scene.select({});
        CHECK(scene.out->piece_count == 3);
    }

    TEST_CASE("what does not fit is counted, and the nearest stay") {
        Pieces scene;
        testing::Random random(11);
        for (int i = 0; i < 300; ++i)
            scene.add(BodyKind::fixed,
                      Pose(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-3, 3)),
                      row(3, 0.01));
        const Vec2 middle(0.1, -0.2);
        const LeftOut left = scene.select({{middle, 10.0}});
        CHECK(scene.out->body_count <= k_max_bodies);
        CHECK(scene.out->piece_count == k_max_pieces);
        CHECK(left.pieces == 900 - k_max_pieces);
        CHECK(left.bodies == 300 - scene.out->body_count);
        // nothing that was left out is nearer than what was taken
        double farthest = 0.0;
        std::vector<bool> taken(301, false);
        for (int b = 0; b < scene.out->body_count; ++b) {
            const Body& body = scene.out->body[static_cast<std::size_t>(b)];
            taken[body.id] = true;
            for (int k = 0; k < body.piece_count; ++k) {
                const Piece& piece = scene.out->piece[static_cast<std::size_t>(body.first_piece + k)];
                farthest = std::max(farthest, distance_to(bounds_of(piece.convex), body.pose, middle));
            }
        }
        for (const Candidate& c : scene.candidates)
            if (!taken[c.body.id])
                for (const PieceBounds& b : c.bounds)
                    CHECK(distance_to(b, c.body.pose, middle) >= farthest - 1e-12);
    }

    TEST_CASE("more bodies than fit: the nearest bodies stay, in the order given") {
        Pieces scene;
        for (int i = 0; i < 200; ++i)
            scene.add(BodyKind::fixed, Pose(0.01 * (199 - i), 0, 0), row(1, 0.0));
        const LeftOut left = scene.select({{Vec2(0, 0), 5.0}});
        CHECK(left.bodies == 200 - k_max_bodies);
        REQUIRE(scene.out->body_count == k_max_bodies);
        for (int b = 0; b < k_max_bodies; ++b)
            CHECK(scene.out->body[static_cast<std::size_t>(b)].id ==
                  static_cast<std::uint64_t>(200 - k_max_bodies + b + 1));
    }
}
