#pragma once
/// A convex outline with rounded corners: a core polygon grown by a radius. One vertex is a disc, two a capsule (radius 0: a
/// segment), three and more a polygon. A half-plane is a kind of its own.

#include <haptics/core/types.hpp>

#include <array>
#include <cstdint>

namespace haptics {

/// Most vertices of one convex piece; a larger outline is cut into several pieces.
inline constexpr int k_max_vertices = 16;

/// One convex piece in the axes of its body (m).
struct Convex {
    /// Number of core vertices, 1 to k_max_vertices; ignored for a half-plane.
    int count{0};
    /// The solid lies behind vertex[0] against normal[0], without end.
    bool half_plane{false};
    /// Edges that lie inside other solid matter (seams of a wall cut into pieces) and must not be felt: bit i is the edge from
    /// vertex i to vertex i + 1.
    std::uint16_t hidden_edges{0};
    /// Rounding added around the core, m, >= 0.
    double radius{0.0};
    /// Core vertices, counter-clockwise.
    std::array<Vec2, k_max_vertices> vertex;
    /// Outward unit normal of the edge from vertex i to vertex i + 1.
    std::array<Vec2, k_max_vertices> normal;
};

} // namespace haptics
