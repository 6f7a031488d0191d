#pragma once
/// Checks what an author drew, and the area, centroid and inertia of it. Off the haptic loop; may allocate.

#include <haptics/core/types.hpp>

#include <span>
#include <vector>

namespace haptics {

/// What is wrong with an outline.
enum class OutlineError {
    none,
    empty,          ///< no points at all
    not_finite,     ///< a coordinate is NaN or infinite
    too_few_points, ///< fewer than three different points
    zero_area,      ///< all points lie on one line
    self_crossing,  ///< two edges cross or touch
};

/// A checked outline.
struct CheckedOutline {
    OutlineError error{OutlineError::none};
    /// Index (in the drawn outline) of the point or edge that is wrong; -1 when it is the outline as a whole.
    int where{-1};
    /// The outline without repeated points, counter-clockwise; empty when there is an error.
    std::vector<Vec2> points;
};

/// Checks an outline of any winding; the last point joins the first. Points nearer than `merge` (m) are one.
[[nodiscard]] CheckedOutline validate_outline(std::span<const Vec2> outline, double merge = 1e-7);

/// What to do about it: one short sentence.
[[nodiscard]] const char* remedy(OutlineError error);

/// Area and its first two moments.
struct AreaProperties {
    /// Area, m^2, > 0.
    double area{0.0};
    /// Center of area, m.
    Vec2 centroid{0.0, 0.0};
    /// Integral of the squared distance from the centroid, m^4. Times mass / area it is the moment of inertia
    /// in kg m^2.
    double second_moment{0.0};
};

/// Properties of a simple outline of either winding.
[[nodiscard]] AreaProperties area_properties(std::span<const Vec2> outline);

/// Whether all corners of a counter-clockwise outline turn left (straight ones allowed).
[[nodiscard]] bool is_convex(std::span<const Vec2> outline);

} // namespace haptics
