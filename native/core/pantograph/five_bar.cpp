// Circles about a and b with radii r_a, r_b; c = b - a, D = |c|. A point of both has, along c, the coordinate
//   u = (D^2 + r_a^2 - r_b^2) / (2 D),   across it  w = +-sqrt(r_a^2 - u^2).
// No common point: |u| > r_a. Then u is cut to [-r_a, r_a] and w is 0, which is the point of circle a nearest
// to circle b.

#include <haptics/core/pantograph/five_bar.hpp>

#include <algorithm>
#include <cmath>

namespace haptics {

CirclePoint intersect_circles(const Vec2& a, double radius_a, const Vec2& b, double radius_b, int side) {
    const Vec2 between = b - a;
    const double squared = between.squaredNorm();
    // concentric, or not a number at all
    if (!(squared > 1.0e-24) || !std::isfinite(squared))
        return {a.allFinite() ? Vec2(a + Vec2(radius_a, 0.0)) : Vec2(Vec2::Zero()), false};
    const double distance = std::sqrt(squared);
    const double along = (squared + radius_a * radius_a - radius_b * radius_b) / (2.0 * distance);
    const double cut = std::clamp(along, -radius_a, radius_a);
    const double across = std::sqrt(std::max(0.0, radius_a * radius_a - cut * cut));
    const Vec2 direction = between / distance;
    return {a + cut * direction + (side > 0 ? across : -across) * perpendicular(direction), cut == along};
}

} // namespace haptics
