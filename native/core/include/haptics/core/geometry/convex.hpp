#pragma once
/// A convex outline with rounded corners: a core polygon grown by a radius. One vertex is a disc, two a
/// capsule (radius 0: a segment), three and more a polygon. A half-plane is a kind of its own.

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
    /// Edges that lie inside other solid matter (seams of a wall cut into pieces) and must not be felt: bit i
    /// is the edge from vertex i to vertex i + 1.
    std::uint16_t hidden_edges{0};
    /// Vertices that are no corner of the solid as a whole (in the middle of a flat face, in a concave
    /// corner, inside other matter) and must not be felt: bit i is vertex i. Set by mark_seams.
    std::uint16_t ghost_vertices{0};
    /// Vertices that are a corner of the solid as a whole, but of a blunter one than this piece shows: bit i
    /// says that cone_from[i] and cone_to[i] hold. Set by mark_seams.
    std::uint16_t blunt_vertices{0};
    /// Rounding added around the core, m, >= 0. Hidden edges are not shrunk for it: they stay on the core's
    /// own line.
    double radius{0.0};
    /// Core vertices, counter-clockwise.
    std::array<Vec2, k_max_vertices> vertex;
    /// Outward unit normal of the edge from vertex i to vertex i + 1.
    std::array<Vec2, k_max_vertices> normal;
    /// The flat face that edge i belongs to goes on by this much before vertex i and after vertex i + 1, in
    /// other pieces of the same solid, m. May be negative: that part of the edge lies inside other matter.
    /// Set by mark_seams.
    std::array<double, k_max_vertices> face_before{};
    std::array<double, k_max_vertices> face_after{};
    /// Normals felt at a blunt vertex: counter-clockwise from cone_from to cone_to (body axes). Set by
    /// mark_seams.
    std::array<Eigen::Vector2f, k_max_vertices> cone_from;
    std::array<Eigen::Vector2f, k_max_vertices> cone_to;
};

} // namespace haptics
