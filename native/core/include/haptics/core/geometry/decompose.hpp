#pragma once
/// Cuts an outline of any form into convex pieces. Off the haptic loop; allocates.

#include <haptics/core/geometry/convex.hpp>
#include <haptics/core/geometry/outline.hpp>

#include <vector>

namespace haptics {

/// Convex pieces of an outline.
struct Decomposition {
    OutlineError error{OutlineError::none};
    /// See CheckedOutline::where.
    int where{-1};
    /// Pieces of at most k_max_vertices corners; the cuts between them are marked as hidden edges.
    std::vector<Convex> pieces;
};

/// Checks the outline (either winding, concave or not) and cuts it into convex pieces with rounded convex
/// corners.
[[nodiscard]] Decomposition decompose(std::span<const Vec2> outline, double rounding = 0.0);

} // namespace haptics
