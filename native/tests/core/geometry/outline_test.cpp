#include <haptics/core/geometry/decompose.hpp>
#include <haptics/core/geometry/outline.hpp>
#include <haptics/core/geometry/shapes.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <random>

using namespace haptics;

namespace {

using Outline = std::vector<Vec2>;

OutlineError error_of(const Outline& outline) {
    return validate_outline(outline).error;
}

/// A star-shaped outline with random radii: always simple, mostly concave.
Outline random_outline(std::mt19937_64& random, int count) {
    std::uniform_real_distribution<double> radius(0.01, 0.05);
    Outline outline;
    for (int i = 0; i < count; ++i)
        outline.push_back(radius(random) * rotate(2.0 * 3.14159265358979 * i / count, Vec2{1, 0}));
    return outline;
}

/// Crossing-number test.
bool holds(const Outline& outline, const Vec2& p) {
    bool inside = false;
    for (std::size_t i = 0, k = outline.size() - 1; i < outline.size(); k = i++) {
        const Vec2& a = outline[i];
        const Vec2& b = outline[k];
        if ((a.y() > p.y()) != (b.y() > p.y()) &&
            p.x() < (b.x() - a.x()) * (p.y() - a.y()) / (b.y() - a.y()) + a.x())
            inside = !inside;
    }
    return inside;
}

bool holds(const Convex& convex, const Vec2& p) {
    for (std::size_t i = 0; i < static_cast<std::size_t>(convex.count); ++i)
        if (convex.normal[i].dot(p - convex.vertex[i]) > 0.0)
            return false;
    return true;
}

} // namespace

TEST_CASE("each mistake in an outline has its own error and remedy") {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    CHECK(error_of({}) == OutlineError::empty);
    CHECK(error_of({{0, 0}, {1, 0}}) == OutlineError::too_few_points);
    CHECK(error_of({{0, 0}, {1, 0}, {1, 0}, {0, 0}}) == OutlineError::too_few_points);
    CHECK(error_of({{0, 0}, {1, nan}, {0, 1}}) == OutlineError::not_finite);
    CHECK(error_of({{0, 0}, {1, 1}, {2, 2}, {3, 3}}) == OutlineError::zero_area);
    CHECK(error_of({{0, 0}, {1, 1}, {1, 0}, {0, 1}}) == OutlineError::self_crossing);
    CHECK(error_of({{0, 0}, {2, 0}, {2, 1}, {1, 0}, {0, 1}}) == OutlineError::self_crossing);
    CHECK(error_of({{0, 0}, {2, 0}, {1, 0}, {1, 1}}) == OutlineError::self_crossing);
    CHECK(error_of({{0, 0}, {1, 0}, {1, 1}, {0, 1}}) == OutlineError::none);
    for (const OutlineError error :
         {OutlineError::empty, OutlineError::not_finite, OutlineError::too_few_points,
          OutlineError::zero_area, OutlineError::self_crossing})
        CHECK(std::strlen(remedy(error)) > 10);
}

TEST_CASE("repeated points are merged and the winding is counter-clockwise") {
    const CheckedOutline checked = validate_outline(Outline{{0, 0}, {0, 1}, {0, 1}, {1, 1}, {1, 0}, {0, 0}});
    CHECK(checked.error == OutlineError::none);
    REQUIRE(checked.points.size() == 4);
    CHECK(is_convex(checked.points));
}

TEST_CASE("area, centroid and second moment match closed forms in any place and winding") {
    const Vec2 at{3.0, -2.0};
    const AreaProperties box =
        area_properties(Outline{at, at + Vec2{0, 0.2}, at + Vec2{0.1, 0.2}, at + Vec2{0.1, 0}});
    CHECK(box.area == doctest::Approx(0.02));
    CHECK((box.centroid - (at + Vec2{0.05, 0.1})).norm() < 1e-14);
    CHECK(box.second_moment == doctest::Approx(0.02 * (0.01 + 0.04) / 12.0));
    Outline circle;
    for (int i = 0; i < 4000; ++i)
        circle.push_back(at + rotate(i * 3.14159265358979 / 2000.0, Vec2{0.1, 0}));
    const AreaProperties disc = area_properties(circle);
    CHECK(disc.second_moment == doctest::Approx(0.5 * 3.14159265358979 * 1e-4).epsilon(1e-5));
}

TEST_CASE("rounding leaves the flat faces where they were drawn, and gives way when it is too large") {
    const Convex box = make_box(Vec2{0, 0}, Vec2{0.04, 0.02}, 0.003);
    CHECK(box.count == 4);
    for (std::size_t i = 0; i < 4; ++i)
        CHECK(box.normal[i].dot(box.vertex[i]) + box.radius ==
              doctest::Approx(std::abs(box.normal[i].x()) > 0.5 ? 0.02 : 0.01).epsilon(1e-12));
    const Convex tight = make_box(Vec2{0, 0}, Vec2{0.04, 0.02}, 1.0);
    CHECK(tight.radius < 0.01);
    CHECK(tight.radius > 0.0097);
    std::array<Vec2, k_max_vertices> corner;
    REQUIRE(drawn_corners(tight, corner) == 4);
    CHECK((corner[2] - Vec2{0.02, 0.01}).norm() < 1e-14);
    // clockwise and straight points
    const Convex triangle = make_convex(std::array{Vec2{0, 0}, Vec2{0, 1}, Vec2{0.5, 0.5}, Vec2{1, 0}}, 0.0);
    CHECK(triangle.count == 3);
    CHECK(cross(triangle.vertex[1] - triangle.vertex[0], triangle.vertex[2] - triangle.vertex[1]) > 0.0);
}

TEST_CASE("concave outlines are cut into convex pieces that fill them without overlap") {
    std::mt19937_64 random(3);
    for (int trial = 0; trial < 300; ++trial) {
        CAPTURE(trial);
        const Outline outline = random_outline(random, 4 + static_cast<int>(random() % 40));
        const Decomposition cut = decompose(outline);
        REQUIRE(cut.error == OutlineError::none);
        double area = 0.0;
        for (const Convex& piece : cut.pieces) {
            REQUIRE(piece.count >= 3);
            REQUIRE(piece.count <= k_max_vertices);
            const std::span<const Vec2> points(piece.vertex.data(), static_cast<std::size_t>(piece.count));
            CHECK(is_convex(points));
            area += area_properties(points).area;
        }
        CHECK(area == doctest::Approx(area_properties(outline).area).epsilon(1e-9));
        std::uniform_real_distribution<double> place(-0.05, 0.05);
        for (int i = 0; i < 50; ++i) {
            const Vec2 p{place(random), place(random)};
            const bool filled = std::any_of(cut.pieces.begin(), cut.pieces.end(),
                                            [&p](const Convex& piece) { return holds(piece, p); });
            CHECK(filled == holds(outline, p));
        }
    }
}

TEST_CASE("every hidden edge of a cut outline is inside, every felt one on the outline") {
    std::mt19937_64 random(4);
    for (int trial = 0; trial < 100; ++trial) {
        CAPTURE(trial);
        const Outline outline = random_outline(random, 5 + static_cast<int>(random() % 20));
        const Decomposition cut = decompose(outline);
        for (const Convex& piece : cut.pieces) {
            for (int i = 0; i < piece.count; ++i) {
                const auto k = static_cast<std::size_t>(i);
                const auto next = static_cast<std::size_t>((i + 1) % piece.count);
                const Vec2 beyond = 0.5 * (piece.vertex[k] + piece.vertex[next]) + 2e-5 * piece.normal[k];
                if ((piece.vertex[k] - piece.vertex[next]).norm() > 1e-3)
                    CHECK(is_hidden(piece, i) == holds(outline, beyond));
            }
        }
    }
}
