#pragma once
/// The two circle problems of a five-bar: elbow from end point, end point from elbows.

#include <haptics/core/types.hpp>

namespace haptics {

/// A point found by intersecting two circles.
struct CirclePoint {
    Vec2 point{0.0, 0.0};
    /// False when the circles do not meet; `point` is then the nearest on the line of centers. Always finite.
    bool meets{false};
};

/// Intersection of the circles (a, radius_a) and (b, radius_b), m, that lies left (side > 0) or right (side <
/// 0) of the ray from a to b. Concentric circles do not meet.
CirclePoint intersect_circles(const Vec2& a, double radius_a, const Vec2& b, double radius_b, int side);

} // namespace haptics
