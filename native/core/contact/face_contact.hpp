#pragma once
/// Contact of a flat face with whatever of another piece is in front of (or behind) it.

#include <haptics/core/contact/contact.hpp>
#include <haptics/core/contact/placed_convex.hpp>

namespace haptics::contact {

/// How far a piece is in front of a face.
struct FaceSeparation {
    /// Face (edge index) of the owner, -1 when there is none.
    int face{-1};
    /// Vertex of the other piece that is deepest behind the face.
    int deepest{0};
    /// Distance of the cores along the face's normal, m; negative when the other core is behind the face.
    double separation{0.0};
};

/// Distance of `other`'s core from one face of `owner`.
[[nodiscard]] FaceSeparation face_separation(const PlacedConvex& owner, int face, const PlacedConvex& other);

/// The face of `owner` that `other` is farthest in front of (faces -1 when owner is a disc).
[[nodiscard]] FaceSeparation widest_separation(const PlacedConvex& owner, const PlacedConvex& other);

/// Points of a contact along a face.
struct FacePoints {
    int count{0};
    /// Point of the other piece's core in front of the face.
    std::array<Vec2, 2> core;
    /// Signed distance of the two surfaces there, m.
    std::array<double, 2> gap;
    /// Incident edge of the other piece, -1 when it shows a vertex only.
    int edge{-1};
};

/// Clips the part of `other` that faces the given face to the extent of the face (including the parts of the
/// same flat face in other pieces). False when nothing of it is in front of or behind the face's extent.
bool face_points(const PlacedConvex& owner, const FaceSeparation& face, const PlacedConvex& other,
                 FacePoints& points);

/// Whether the solid that `piece` is part of can show a normal `direction` (scene axes, outward) at vertex
/// `i`; false on seams.
[[nodiscard]] bool shows_normal(const PlacedConvex& piece, int i, const Vec2& direction);

} // namespace haptics::contact
