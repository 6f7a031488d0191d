#pragma once
/// Bounds of bodies and pieces that hold in every pose. They change only with the shapes, so whoever keeps a
/// BodySet computes them once per snapshot and not at every haptic step.

#include <haptics/core/contact/body.hpp>

#include <array>

namespace haptics {

/// Bounds of one piece in the axes of its body (m); a half-plane is without bound. Written by compute_bounds;
/// nothing is set before.
struct PieceBounds {
    /// Corners of the axis-parallel box around the piece.
    Vec2 low;
    Vec2 high;
    /// Disc around the piece.
    Vec2 center;
    double radius;
};

/// Bounds of all bodies and pieces of a set, same indices.
struct BodyBounds {
    /// Radius about the body's reference point that holds all its pieces, m; infinite with a half-plane.
    std::array<double, k_max_bodies> radius;
    /// A smaller disc that holds them too, in the axes of the body.
    std::array<Vec2, k_max_bodies> center;
    std::array<double, k_max_bodies> extent;
    std::array<PieceBounds, k_max_pieces> piece;
};

/// Bounds of one piece. Allocation-free.
[[nodiscard]] PieceBounds bounds_of(const Convex& convex);

/// Computes the bounds of a set. Allocation-free.
void compute_bounds(const BodySet& set, BodyBounds& bounds);

} // namespace haptics
