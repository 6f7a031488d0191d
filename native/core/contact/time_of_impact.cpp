/// Conservative advancement (Mirtich 1996) with a second-order bound. Let n separate two cores by s > 0 now.
/// A vertex at arm r of a body with twist (v, w) moves along n as n.(v + w x r) t plus a turn whose second
/// derivative is at most w^2 |r|. So
///     s(t) >= min_k (a_k + a'_k t) - max_j (b_j + b'_j t) - radii - 1/2 (w_a^2 R_a + w_b^2 R_b) t^2,
/// a concave bound: it has one root ahead, the bodies cannot touch before it, and a chord from the left never
/// passes it. Advance to the root, separate anew, repeat: the bound is exact to first order, so this
/// converges like Newton's method.

#include <haptics/core/contact/bounds.hpp>
#include <haptics/core/contact/time_of_impact.hpp>

#include <algorithm>
#include <limits>

#include "pair_contact.hpp"

namespace haptics {
namespace {

using namespace contact;

constexpr double k_never = std::numeric_limits<double>::infinity();
/// Cores this near touch, m.
constexpr double k_touch = 1e-9;
/// Aim of the advancement, m: between 0 and k_touch.
constexpr double k_aim = 5e-10;
constexpr int k_advances = 256;
constexpr int k_chords = 16;
/// Cosine between the normals of the patch and of its impact.
constexpr double k_same_way = 0.2;
/// Search range of the contact at the time of touch, m.
constexpr double k_near = 1e-6;

struct Mover {
    const Body& body;
    const Piece& piece;
    const Twist& twist;

    [[nodiscard]] Pose pose(double t) const { return body.pose + t * twist; }
};

/// Lower bound of the separation along one direction, as a function of time.
struct Bound {
    int count_a{0};
    int count_b{0};
    std::array<double, k_max_vertices> a;
    std::array<double, k_max_vertices> a_rate;
    std::array<double, k_max_vertices> b;
    std::array<double, k_max_vertices> b_rate;
    double radii{0.0};
    double bend{0.0};

    [[nodiscard]] double at(double t) const {
        double low = k_never;
        double high = -k_never;
        for (std::size_t k = 0; k < static_cast<std::size_t>(count_a); ++k)
            low = std::min(low, a[k] + a_rate[k] * t);
        for (std::size_t k = 0; k < static_cast<std::size_t>(count_b); ++k)
            high = std::max(high, b[k] + b_rate[k] * t);
        return low - high - radii - bend * t * t;
    }
};

/// Fills in one side; returns the largest arm.
double project(const PlacedConvex& placed, const Vec2& center, const Twist& twist, const Vec2& n,
               std::array<double, k_max_vertices>& height, std::array<double, k_max_vertices>& rate) {
    double arm = 0.0;
    for (int i = 0; i < placed.count; ++i) {
        const auto k = static_cast<std::size_t>(i);
        const Vec2 r = placed.v(i) - center;
        height[k] = n.dot(r) + n.dot(center);
        rate[k] = n.dot(velocity_at(twist, r));
        arm = std::max(arm, r.squaredNorm());
    }
    return std::sqrt(arm);
}

Bound bound_along(const PlacedConvex& a, const PlacedConvex& b, const Mover& mover_a, const Mover& mover_b,
                  const Vec2& center_a, const Vec2& center_b, const Vec2& n) {
    Bound bound;
    bound.count_a = a.count;
    bound.count_b = b.count;
    bound.radii = a.radius + b.radius;
    const double wa = mover_a.twist.z();
    const double wb = mover_b.twist.z();
    const double arm_a = project(a, center_a, mover_a.twist, n, bound.a, bound.a_rate);
    double arm_b = project(b, center_b, mover_b.twist, n, bound.b, bound.b_rate);
    bound.bend = 0.5 * wa * wa * arm_a;
    if (wb == 0.0)
        return bound;
    if (b.half_plane) { // turning ground: seen from it, a moves
        for (int i = 0; i < a.count; ++i)
            bound.a_rate[static_cast<std::size_t>(i)] -= n.dot(velocity_at(mover_b.twist, a.v(i) - center_b));
        bound.b_rate[0] = 0.0;
        arm_b = (center_a - center_b).norm() + arm_a;
        bound.bend +=
            std::abs(wb) * ((mover_a.twist - mover_b.twist).head<2>().norm() + std::abs(wa) * arm_a);
    }
    bound.bend += 0.5 * wb * wb * arm_b;
    return bound;
}

/// Last time up to `end` before which the bound stays above `aim`.
double safe_until(const Bound& bound, double aim, double end) {
    double right = end;
    double right_value = bound.at(right) - aim;
    if (right_value >= 0.0)
        return end;
    double left = 0.0;
    double left_value = bound.at(0.0) - aim;
    if (left_value <= 0.0)
        return 0.0;
    for (int i = 0; i < k_chords && left_value > 0.1 * aim; ++i) {
        left += (right - left) * left_value / (left_value - right_value);
        left_value = bound.at(left) - aim;
        // tangent from the right, and the middle when that is better
        const double middle = 0.5 * (left + right);
        const double middle_value = bound.at(middle) - aim;
        if (middle_value < 0.0) {
            right = middle;
            right_value = middle_value;
        } else {
            left = middle;
            left_value = middle_value;
        }
    }
    return left;
}

/// Time at which two pieces touch, and the direction.
double pieces_touch(const Mover& a, const Mover& b, double step, const Vec2& patch_normal) {
    double t = 0.0;
    PlacedConvex placed_a;
    PlacedConvex placed_b;
    for (int i = 0; i < k_advances; ++i) {
        const Pose pose_a = a.pose(t);
        const Pose pose_b = b.pose(t);
        const Transform at_b(pose_b);
        place(a.piece.convex, Transform(pose_a), placed_a);
        place(b.piece.convex, at_b, placed_b);
        Vec2 n;
        const double gap = separate(placed_a, placed_b, n);
        if (gap <= k_touch) {
            if (i == 0 && gap <= 0.0)
                return k_never; // overlapping already
            PairQuery query;
            query.limit = k_near;
            query.one_way = b.piece.one_way;
            if (query.one_way)
                query.one_way_normal = at_b.turn(b.piece.one_way_normal);
            PairContact contact;
            const bool felt = collide(placed_a, placed_b, query, contact);
            return felt && contact.normal.dot(patch_normal) > k_same_way ? t : k_never;
        }
        if (t >= step)
            return k_never;
        const Bound bound = bound_along(placed_a, placed_b, a, b, pose_a.head<2>(), pose_b.head<2>(), n);
        t += safe_until(bound, k_aim, step - t);
    }
    return t;
}

const Body& body_at(const BodySet& tool, const BodySet& neighbors, std::int32_t index) {
    return index < tool.body_count ? tool.body[static_cast<std::size_t>(index)]
                                   : neighbors.body[static_cast<std::size_t>(index - tool.body_count)];
}

const Piece* pieces_of(const BodySet& tool, const BodySet& neighbors, std::int32_t index) {
    const BodySet& set = index < tool.body_count ? tool : neighbors;
    return &set.piece[static_cast<std::size_t>(body_at(tool, neighbors, index).first_piece)];
}

} // namespace

double time_of_impact(const BodySet& tool, const BodySet& neighbors, const Patch& patch, const Twist& twist_a,
                      const Twist& twist_b, double step) {
    const Body& a = body_at(tool, neighbors, patch.body_a);
    const Body& b = body_at(tool, neighbors, patch.body_b);
    const Piece* pieces_a = pieces_of(tool, neighbors, patch.body_a);
    const bool all_fixed = b.kind == BodyKind::fixed;
    double first = step;
    bool found = false;
    for (std::int32_t k = tool.body_count; k < tool.body_count + neighbors.body_count; ++k) {
        const Body& other = body_at(tool, neighbors, k);
        if (k == patch.body_a || (all_fixed ? other.kind != BodyKind::fixed : k != patch.body_b))
            continue;
        const Piece* pieces_b = pieces_of(tool, neighbors, k);
        for (std::int32_t i = 0; i < a.piece_count; ++i) {
            for (std::int32_t m = 0; m < other.piece_count; ++m) {
                const double t = pieces_touch({a, pieces_a[i], twist_a}, {other, pieces_b[m], twist_b}, first,
                                              patch.normal);
                if (t <= first) {
                    first = t;
                    found = true;
                }
            }
        }
    }
    return found ? first : k_never;
}

} // namespace haptics
