#pragma once
/// The bodies of one haptic step: the links of the tool and the neighbors of the snapshot, with their convex
/// pieces.

#include <haptics/core/contact/surface.hpp>
#include <haptics/core/geometry/convex.hpp>
#include <haptics/core/types.hpp>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

namespace haptics {

/// Who moves a body.
enum class BodyKind : std::uint8_t {
    tool,      ///< a link of what the user holds; the local model moves it
    fixed,     ///< never moves
    kinematic, ///< moves by the scene's will, cannot be pushed
    movable,   ///< has mass and can be pushed
};

/// One body. Poses and velocities refer to the body's center of mass.
struct Body {
    /// Persistent id, unique in a snapshot; the scene's instance id for neighbors, the link number for the
    /// tool.
    std::uint64_t id{0};
    BodyKind kind{BodyKind::fixed};
    Pose pose{0.0, 0.0, 0.0};
    Twist velocity{0.0, 0.0, 0.0};
    /// Mass in kg and moment of inertia about the center of mass in kg m^2 (movable bodies only, > 0).
    double mass{0.0};
    double inertia{0.0};
    /// A movable body that joints tie to others, a link of a linkage that runs beside the tool (see
    /// free_linkage.hpp): `mobility` and `acceleration` count, not mass and inertia. It touches the tool and
    /// free movables; what else it touches is in the two.
    bool jointed{false};
    /// Which linkage (the number it was attached with) and which link of it.
    std::uint64_t linkage{0};
    std::int32_t link{0};
    /// Velocity (m/s, m/s, rad/s) of the center of mass for a unit impulse on it; positive definite.
    Mat3 mobility{Mat3::Zero()};
    /// Acceleration that the tool's contacts add to, m/s^2, m/s^2, rad/s^2. Of a movable body that is not
    /// jointed: beyond the neighborhood's gravity, for one that falls otherwise.
    Twist acceleration{0.0, 0.0, 0.0};
    Surface surface;
    /// Layers that it is on, and those that it meets.
    std::uint32_t layer{~0U};
    std::uint32_t mask{~0U};
    /// Friction that the scene's own solver has on this body; negative where it bears on smoother bodies too.
    /// Not a number: the scene does not solve its contacts, and the surface counts everywhere.
    double scene_friction{std::numeric_limits<double>::quiet_NaN()};
    /// How much of the body is there, 0 to 1: what appears or leaves under the tool fades. 1 in a snapshot.
    double presence{1.0};
    /// Range of this body's pieces in the piece array.
    std::int32_t first_piece{0};
    std::int32_t piece_count{0};
};

/// Surface of a contact of two bodies. What two neighbors do to each other the scene decides: its friction
/// counts there, so that what is foreseen is what it will do.
inline Surface surface_between(const Body& a, const Body& b) {
    Surface s = combine(a.surface, b.surface);
    const double friction = std::min(a.scene_friction, b.scene_friction);
    if (a.kind != BodyKind::tool && !std::isnan(a.scene_friction) && !std::isnan(b.scene_friction))
        s.static_friction = s.dynamic_friction = std::abs(friction);
    return s;
}

/// Whether two neighbors meet: one that moves by its mass meets what its mask selects, a jointed one decides
/// for the two.
inline bool do_meet(const Body& a, const Body& b) {
    if (a.jointed || b.jointed)
        return ((a.jointed ? a.mask : b.mask) & (a.jointed ? b.layer : a.layer)) != 0;
    return (a.kind == BodyKind::movable && (a.mask & b.layer) != 0) ||
           (b.kind == BodyKind::movable && (b.mask & a.layer) != 0);
}

/// One convex piece with an id that stays the same while the scene keeps the shape.
struct Piece {
    std::uint32_t id{0};
    /// Acts only on what comes from the side of the local direction `one_way_normal` (body axes).
    bool one_way{false};
    Vec2 one_way_normal{0.0, 1.0};
    Convex convex;
};

inline constexpr int k_max_bodies = 128;
inline constexpr int k_max_pieces = 256;

/// Pointer-free set of bodies.
struct BodySet {
    std::int32_t body_count{0};
    std::int32_t piece_count{0};
    std::array<Body, k_max_bodies> body;
    std::array<Piece, k_max_pieces> piece;
};

} // namespace haptics
