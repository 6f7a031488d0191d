#pragma once
/// Tells the pieces of one solid which of their edges and corners are only cuts. Off the haptic loop;
/// allocates.

#include <haptics/core/geometry/convex.hpp>

#include <span>

namespace haptics {

/// One piece of a solid that was cut into several, wherever its body stands.
struct SeamPiece {
    Convex* convex{nullptr};
    /// Pose of its body.
    Pose pose{0.0, 0.0, 0.0};
    /// Flat faces go on from piece to piece only where this is equal (the surface).
    int face_group{0};
};

/// Sets hidden_edges, ghost_vertices, blunt_vertices, cones and face extents of all pieces of one solid.
/// Pieces may abut, overlap, or leave gaps up to `tolerance` (m). Edges found hidden for the first time are
/// moved out to where they were drawn, so that a rounded piece fills its seam. Calling it again changes
/// nothing.
void mark_seams(std::span<SeamPiece> solid, double tolerance = 5e-6);

} // namespace haptics
