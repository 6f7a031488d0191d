/// Rounded outlines.
///
/// Edge i lies on the line n_i . x = c_i. Shrunk by r it lies on n_i . x = c_i - r_i, with r_i = r on felt
/// edges and 0 on hidden ones. Corner i is where the lines i - 1 and i cross, so it moves by the d that
/// solves
///     n_{i-1} . d = -r_{i-1},   n_i . d = -r_i,
/// which is linear in r, and so is every edge length: L_i(r) = L_i - r c_i. The largest rounding is min_i L_i
/// / c_i.

#include <haptics/core/geometry/shapes.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace haptics {
namespace {

/// Displacement of the corner between two lines when they move inward by r0 and r1.
Vec2 corner_shift(const Vec2& n0, const Vec2& n1, double r0, double r1) {
    const double det = cross(n0, n1);
    if (std::abs(det) < 1e-9)
        return -std::max(r0, r1) * n0;
    return Vec2{-r0 * n1.y() + r1 * n0.y(), -r1 * n0.x() + r0 * n1.x()} / det;
}

void set_normals(Convex& convex) {
    const int n = convex.count;
    for (int i = 0; i < n; ++i) {
        const auto k = static_cast<std::size_t>(i);
        const Vec2 edge = convex.vertex[static_cast<std::size_t>((i + 1) % n)] - convex.vertex[k];
        convex.normal[k] = -perpendicular(edge).normalized();
    }
}

bool hidden_bit(std::uint16_t mask, int i) {
    return ((mask >> i) & 1U) != 0U;
}

/// Moves every corner as its two edges move inward by `inset` where felt and by 0 where hidden.
void shift_corners(const Convex& convex, double inset, std::array<Vec2, k_max_vertices>& corner) {
    const int n = convex.count;
    for (int i = 0; i < n; ++i) {
        const int before = (i + n - 1) % n;
        const double r0 = hidden_bit(convex.hidden_edges, before) ? 0.0 : inset;
        const double r1 = hidden_bit(convex.hidden_edges, i) ? 0.0 : inset;
        const auto k = static_cast<std::size_t>(i);
        corner[k] = convex.vertex[k] +
                    corner_shift(convex.normal[static_cast<std::size_t>(before)], convex.normal[k], r0, r1);
    }
}

/// Largest inset that leaves every edge some length.
double largest_inset(const Convex& convex) {
    std::array<Vec2, k_max_vertices> moved;
    shift_corners(convex, 1.0, moved);
    double largest = std::numeric_limits<double>::infinity();
    for (int i = 0; i < convex.count; ++i) {
        const auto k = static_cast<std::size_t>(i);
        const auto next = static_cast<std::size_t>((i + 1) % convex.count);
        const Vec2 along = perpendicular(convex.normal[k]);
        const double length = (convex.vertex[next] - convex.vertex[k]).dot(along);
        const double shortening = length - (moved[next] - moved[k]).dot(along);
        if (shortening > 0.0)
            largest = std::min(largest, length / shortening);
    }
    return largest;
}

} // namespace

Convex make_disc(const Vec2& center, double radius) {
    Convex convex;
    convex.count = 1;
    convex.radius = radius;
    convex.vertex[0] = center;
    convex.normal[0] = Vec2{0.0, 1.0};
    return convex;
}

Convex make_capsule(const Vec2& from, const Vec2& to, double radius) {
    if ((to - from).squaredNorm() < 1e-24)
        return make_disc(from, radius);
    Convex convex;
    convex.count = 2;
    convex.radius = radius;
    convex.vertex[0] = from;
    convex.vertex[1] = to;
    set_normals(convex);
    return convex;
}

Convex make_segment(const Vec2& from, const Vec2& to) {
    return make_capsule(from, to, 0.0);
}

Convex make_half_plane(const Vec2& point, const Vec2& normal) {
    Convex convex;
    convex.count = 1;
    convex.half_plane = true;
    convex.vertex[0] = point;
    convex.normal[0] = normal.normalized();
    return convex;
}

Convex make_box(const Vec2& center, const Vec2& size, double rounding) {
    const Vec2 h = 0.5 * size;
    const std::array<Vec2, 4> outline{Vec2{center - h}, Vec2{center.x() + h.x(), center.y() - h.y()},
                                      Vec2{center + h}, Vec2{center.x() - h.x(), center.y() + h.y()}};
    return make_convex(outline, rounding);
}

Convex make_convex(std::span<const Vec2> outline, double rounding, std::uint16_t hidden_edges) {
    Convex convex;
    const int n = static_cast<int>(outline.size());
    if (n < 3 || n > k_max_vertices)
        return convex;
    double twice_area = 0.0;
    for (int i = 0; i < n; ++i)
        twice_area += cross(outline[static_cast<std::size_t>(i)] - outline[0],
                            outline[static_cast<std::size_t>((i + 1) % n)] - outline[0]);
    if (!(std::abs(twice_area) > 0.0))
        return convex;

    // counter-clockwise copy
    std::array<Vec2, k_max_vertices> point;
    std::uint16_t hidden = 0;
    for (int i = 0; i < n; ++i) {
        const int from = twice_area > 0.0 ? i : n - 1 - i;
        const int edge = twice_area > 0.0 ? i : (2 * n - 2 - i) % n;
        point[static_cast<std::size_t>(i)] = outline[static_cast<std::size_t>(from)];
        if (hidden_bit(hidden_edges, edge))
            hidden = static_cast<std::uint16_t>(hidden | (1U << i));
    }

    // drop points on a straight line
    for (int i = 0; i < n; ++i) {
        const int before = (i + n - 1) % n;
        const Vec2 in = point[static_cast<std::size_t>(i)] - point[static_cast<std::size_t>(before)];
        const Vec2 out = point[static_cast<std::size_t>((i + 1) % n)] - point[static_cast<std::size_t>(i)];
        const bool straight = std::abs(cross(in, out)) < 1e-12 * in.norm() * out.norm();
        if (straight && hidden_bit(hidden, before) == hidden_bit(hidden, i))
            continue;
        const auto k = static_cast<std::size_t>(convex.count++);
        convex.vertex[k] = point[static_cast<std::size_t>(i)];
        if (hidden_bit(hidden, i))
            convex.hidden_edges = static_cast<std::uint16_t>(convex.hidden_edges | (1U << k));
    }
    if (convex.count < 3)
        return Convex{};
    set_normals(convex);

    if (rounding > 0.0) {
        convex.radius = std::min(rounding, 0.98 * largest_inset(convex));
        shrink_core(convex);
    }
    return convex;
}

void shrink_core(Convex& convex) {
    std::array<Vec2, k_max_vertices> core;
    shift_corners(convex, convex.radius, core);
    std::copy_n(core.begin(), convex.count, convex.vertex.begin());
}

int drawn_corners(const Convex& convex, std::array<Vec2, k_max_vertices>& corner) {
    if (convex.half_plane || convex.count < 3 || convex.radius <= 0.0)
        corner = convex.vertex;
    else
        shift_corners(convex, -convex.radius, corner);
    return convex.count;
}

} // namespace haptics
