/// With the triangles (o, p_i, p_{i+1}) of signed double area c_i = p_i x p_{i+1} (o any point, here the
/// first one):
///     A = 1/2 sum c_i,   C = 1/(6 A) sum c_i (p_i + p_{i+1}),
///     J_o = 1/12 sum c_i (p_i.p_i + p_i.p_{i+1} + p_{i+1}.p_{i+1}),   J_C = J_o - A |C - o|^2.

#include <haptics/core/geometry/outline.hpp>

#include <algorithm>
#include <cmath>

namespace haptics {
namespace {

/// Outlines thinner than this fraction of their length count as lines.
constexpr double k_thin = 1e-9;

double orientation(const Vec2& a, const Vec2& b, const Vec2& c) {
    return cross(b - a, c - a);
}

bool on_segment(const Vec2& p, const Vec2& a, const Vec2& b, double slack) {
    const Vec2 ab = b - a;
    const double t = std::clamp((p - a).dot(ab) / ab.squaredNorm(), 0.0, 1.0);
    return (p - (a + t * ab)).norm() <= slack;
}

/// Whether two segments cross or touch.
bool meet(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d, double slack) {
    const double o1 = orientation(a, b, c);
    const double o2 = orientation(a, b, d);
    const double o3 = orientation(c, d, a);
    const double o4 = orientation(c, d, b);
    if (((o1 > 0.0) != (o2 > 0.0)) && ((o3 > 0.0) != (o4 > 0.0)))
        return true;
    return on_segment(c, a, b, slack) || on_segment(d, a, b, slack) || on_segment(a, c, d, slack) ||
           on_segment(b, c, d, slack);
}

} // namespace

AreaProperties area_properties(std::span<const Vec2> outline) {
    double twice_area = 0.0;
    Vec2 first{0.0, 0.0};
    double polar = 0.0;
    for (std::size_t i = 1; i + 1 < outline.size(); ++i) {
        const Vec2 p = outline[i] - outline[0];
        const Vec2 q = outline[i + 1] - outline[0];
        const double c = cross(p, q);
        twice_area += c;
        first += c * (p + q);
        polar += c * (p.dot(p) + p.dot(q) + q.dot(q));
    }
    AreaProperties properties;
    if (outline.empty() || twice_area == 0.0)
        return properties;
    const Vec2 center = first / (3.0 * twice_area);
    const double area = 0.5 * twice_area;
    properties.area = std::abs(area);
    properties.centroid = outline[0] + center;
    properties.second_moment = std::abs(polar / 12.0 - area * center.squaredNorm());
    return properties;
}

bool is_convex(std::span<const Vec2> outline) {
    const std::size_t n = outline.size();
    for (std::size_t i = 0; i < n; ++i) {
        const Vec2 in = outline[i] - outline[(i + n - 1) % n];
        const Vec2 out = outline[(i + 1) % n] - outline[i];
        if (cross(in, out) < -1e-12 * in.norm() * out.norm())
            return false;
    }
    return true;
}

CheckedOutline validate_outline(std::span<const Vec2> outline, double merge) {
    CheckedOutline checked;
    const auto fail = [&checked](OutlineError error, int where) {
        checked.error = error;
        checked.where = where;
        checked.points.clear();
        return checked;
    };
    if (outline.empty())
        return fail(OutlineError::empty, -1);

    // merge repeated points
    std::vector<int> source;
    for (std::size_t i = 0; i < outline.size(); ++i) {
        if (!outline[i].allFinite())
            return fail(OutlineError::not_finite, static_cast<int>(i));
        if (!checked.points.empty() && (outline[i] - checked.points.back()).norm() <= merge)
            continue;
        checked.points.push_back(outline[i]);
        source.push_back(static_cast<int>(i));
    }
    while (checked.points.size() > 1 && (checked.points.front() - checked.points.back()).norm() <= merge) {
        checked.points.pop_back();
        source.pop_back();
    }
    const std::size_t n = checked.points.size();
    if (n < 3)
        return fail(OutlineError::too_few_points, -1);

    // a line?
    double length = 0.0;
    double thickness = 0.0;
    std::size_t farthest = 0;
    for (std::size_t i = 0; i < n; ++i) {
        if ((checked.points[i] - checked.points[0]).norm() > length) {
            length = (checked.points[i] - checked.points[0]).norm();
            farthest = i;
        }
    }
    for (const Vec2& p : checked.points)
        thickness = std::max(thickness,
                             std::abs(orientation(checked.points[0], checked.points[farthest], p)) / length);
    if (thickness <= std::max(merge, k_thin * length))
        return fail(OutlineError::zero_area, -1);

    // neighbors that fold back, others that meet
    for (std::size_t i = 0; i < n; ++i) {
        const Vec2& a = checked.points[i];
        const Vec2& b = checked.points[(i + 1) % n];
        const Vec2& c = checked.points[(i + 2) % n];
        if ((c - b).dot(a - b) > 0.0 && (on_segment(c, a, b, merge) || on_segment(a, b, c, merge)))
            return fail(OutlineError::self_crossing, source[(i + 1) % n]);
        for (std::size_t k = i + 2; k < n; ++k) {
            if (i == 0 && k == n - 1)
                continue;
            if (meet(a, b, checked.points[k], checked.points[(k + 1) % n], merge))
                return fail(OutlineError::self_crossing, source[k]);
        }
    }

    double twice_area = 0.0;
    for (std::size_t i = 1; i + 1 < n; ++i)
        twice_area += orientation(checked.points[0], checked.points[i], checked.points[i + 1]);
    if (twice_area < 0.0)
        std::reverse(checked.points.begin(), checked.points.end());
    return checked;
}

const char* remedy(OutlineError error) {
    switch (error) {
    case OutlineError::none:
        return "The outline is fine.";
    case OutlineError::empty:
        return "Draw an outline with at least three points.";
    case OutlineError::not_finite:
        return "Replace the coordinate that is not a number.";
    case OutlineError::too_few_points:
        return "Add points: an outline needs three different ones.";
    case OutlineError::zero_area:
        return "Move a point off the line: the outline encloses no area.";
    case OutlineError::self_crossing:
        return "Move the point so that no two edges cross or touch.";
    }
    return "";
}

} // namespace haptics
