#pragma once
/// Makes convex pieces from what an author draws. All of it runs off the haptic loop or at set-up, but
/// allocates nothing.

#include <haptics/core/geometry/convex.hpp>
#include <haptics/core/types.hpp>

#include <cstdint>
#include <span>

namespace haptics {

/// A disc of the given radius (m, > 0).
[[nodiscard]] Convex make_disc(const Vec2& center, double radius);

/// A segment with rounded ends (m, radius > 0); a radius of 0 makes a bare segment with two faces.
[[nodiscard]] Convex make_capsule(const Vec2& from, const Vec2& to, double radius);

/// A segment with two faces and no thickness.
[[nodiscard]] Convex make_segment(const Vec2& from, const Vec2& to);

/// All points behind `point` against `normal` (need not be of unit length).
[[nodiscard]] Convex make_half_plane(const Vec2& point, const Vec2& normal);

/// A box of the given full size (m), axis-parallel, with its corners rounded.
[[nodiscard]] Convex make_box(const Vec2& center, const Vec2& size, double rounding = 0.0);

/// A convex outline of 3 to k_max_vertices points (either winding, no repeated points; see validate_outline),
/// with its corners rounded. The core is shrunk so that the flat faces stay where they were drawn; a rounding
/// that does not fit is reduced. Edges with their bit in `hidden_edges` (edge i runs from point i to point i
/// + 1 of `outline`) are not shrunk. Points on a straight line are dropped unless a hidden edge ends there.
/// Returns a count of 0 when the outline has no area or too many points.
[[nodiscard]] Convex make_convex(std::span<const Vec2> outline, double rounding = 0.0,
                                 std::uint16_t hidden_edges = 0);

/// Corners of the piece as drawn, before its core was shrunk (counter-clockwise; same indices as the core
/// vertices). A disc or capsule gives its core. Writes into `corner` and returns the number of corners.
int drawn_corners(const Convex& convex, std::array<Vec2, k_max_vertices>& corner);

/// Moves the corners of a polygon from where they were drawn to where the core has them, by its radius and
/// hidden edges.
void shrink_core(Convex& convex);

/// Whether edge i (from vertex i to vertex i + 1) lies inside other matter.
[[nodiscard]] inline bool is_hidden(const Convex& convex, int edge) {
    return ((convex.hidden_edges >> edge) & 1U) != 0U;
}
/// Whether vertex i is no corner of the solid as a whole.
[[nodiscard]] inline bool is_ghost(const Convex& convex, int vertex) {
    return ((convex.ghost_vertices >> vertex) & 1U) != 0U;
}

} // namespace haptics
