#pragma once
/// A contact patch: all points where one body touches the matter of another along one plane. A patch, not a
/// vertex, carries the stiffness, the contact state and the friction anchor, so that a wall feels the same
/// however it is cut into shapes.

#include <haptics/core/contact/surface.hpp>
#include <haptics/core/types.hpp>

#include <algorithm>
#include <array>
#include <cstdint>

namespace haptics {

/// States of section 3.2 of the paper (continuous contact is either sticking or sliding).
enum class ContactState : std::uint8_t { none, colliding, sticking, sliding };

/// One point of a patch.
struct PatchPoint {
    /// Scene position on the surface of body b, m.
    Vec2 position{0.0, 0.0};
    /// Signed distance along the normal, m; negative is overlap.
    double gap{0.0};
    /// Share of the patch's stiffness and damping; the shares of a patch add up to 1.
    double weight{1.0};
};

/// What a patch remembers from step to step.
struct PatchMemory {
    ContactState state{ContactState::none};
    /// Tangential displacement of the friction spring from its anchor, m (along the tangent).
    double slip_spring{0.0};
    /// Tool and surface have touched without a break for this many steps.
    std::uint32_t age{0};
    /// Normal and tangential force of the last step, N (telemetry).
    double normal_force{0.0};
    double tangent_force{0.0};
    /// Row of the patch in the step's system, while contacts are looked for again within a step; -1 else.
    std::int32_t row{-1};
};

/// The side from which a patch is felt. Detection writes it and reads it back one step later, so that a body
/// that was pushed through a thin wall still feels the face that it came through. Ids, not indices: they
/// survive a geometry update.
struct PatchSide {
    /// Ids of the two bodies and of the two pieces that gave the deepest point.
    std::uint64_t id_a{0};
    std::uint64_t id_b{0};
    std::uint32_t piece_a{0};
    std::uint32_t piece_b{0};
    /// Body a is a link of the tool; body b never moves (all fixed bodies count as one solid).
    bool tool_a{false};
    bool fixed_b{false};
    /// Owner of the face along whose normal the gaps are measured; none between two rounded corners.
    enum class Face : std::uint8_t { none, of_a, of_b } face{Face::none};
    /// Edge of that face on its piece.
    std::int32_t edge{0};
    /// Normal (out of b into a) in the axes of the face's owner (b without a face), and the offset of the
    /// face's plane from that body's reference point, m.
    Vec2 normal{0.0, 1.0};
    double offset{0.0};
    /// Offset of the same plane from the origin of the scene, m, in case the owner is gone from the snapshot.
    double scene_offset{0.0};
};

/// Bodies in a patch are indices into the step's body list: tool links first, then the neighbors of the
/// snapshot.
struct Patch {
    std::int32_t body_a{0};
    std::int32_t body_b{0};
    /// Persistent ids of the touching features, stable across geometry updates (see detection.hpp).
    std::uint64_t feature_a{0};
    std::uint64_t feature_b{0};
    /// Unit normal in scene axes, out of body b into body a. The tangent is perpendicular(normal).
    Vec2 normal{0.0, 1.0};
    std::int32_t point_count{0};
    std::array<PatchPoint, 2> point;
    /// Combined surface of the two sides.
    Surface surface;
    /// How much of the matter behind the patch is there, 0 to 1 (see Body::presence).
    double presence{1.0};
    PatchMemory memory;
    PatchSide side;
};

/// Most patches of one step; what exceeds it is counted as overflow, the deepest are kept.
inline constexpr int k_max_patches = 64;

/// Fixed-capacity list of the step's patches. A copy takes the patches in use and no more.
struct PatchList {
    PatchList() = default;
    PatchList(const PatchList& other) { *this = other; }
    PatchList& operator=(const PatchList& other) {
        count = other.count;
        overflow = other.overflow;
        std::copy_n(other.patch.begin(), other.count, patch.begin());
        return *this;
    }
    ~PatchList() = default;

    std::int32_t count{0};
    /// Patches found but dropped since the start (a reported fault when it grows).
    std::uint64_t overflow{0};
    std::array<Patch, k_max_patches> patch;
};

} // namespace haptics
