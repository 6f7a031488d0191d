#pragma once
/// What the local model knows of the motion of one neighbor between two snapshots.

#include <haptics/core/types.hpp>

#include <array>
#include <cstdint>

namespace haptics {

/// Velocity that an earlier snapshot told, its time and the length of its tick, s.
struct PastVelocity {
    double time;
    double tick;
    Twist told;
};
inline constexpr std::int32_t k_past_velocities = 8;

/// What the path of a body is shown beside that of its last snapshot: in pose, with its first two
/// derivatives, and in the velocity that contacts feel beyond the share of `rate` that they feel, with its
/// first.
struct PathOffset {
    Pose pose{0.0, 0.0, 0.0};
    Twist rate{0.0, 0.0, 0.0};
    Vec3 bend{0.0, 0.0, 0.0};
    Twist velocity{0.0, 0.0, 0.0};
    Vec3 acceleration{0.0, 0.0, 0.0};

    [[nodiscard]] bool is_zero() const {
        return pose.isZero(0.0) && rate.isZero(0.0) && bend.isZero(0.0) && velocity.isZero(0.0) &&
               acceleration.isZero(0.0);
    }
};

/// Path of a neighbor that the scene moves, and how much of a neighbor is there while it fades in or out.
/// Derivations are in native/core/local_model/path.cpp.
struct Track {
    /// The last snapshot's pose, its time, and the length of its tick, s.
    Pose pose{0.0, 0.0, 0.0};
    double time{0.0};
    double tick{1.0 / 60.0};
    /// Derivatives of the pose at `time`: from the snapshot and, where its predecessors agree, from them.
    Twist velocity{0.0, 0.0, 0.0};
    Vec3 acceleration{0.0, 0.0, 0.0};
    Vec3 jerk{0.0, 0.0, 0.0};
    Vec3 snap{0.0, 0.0, 0.0};
    /// Age up to which the body is extrapolated at full speed, s.
    double reach{2.0 / 60.0};
    /// The scene moves the body; false for a movable that the local model moves.
    bool driven{true};
    /// Stays where it is whatever its velocity says (fixed bodies).
    bool still{false};
    /// The anchors of friction have followed all of the correction below.
    bool settled{true};

    /// When the snapshot was taken, s, and where the body was shown then less where the new path has it,
    /// which is gone `blend` seconds later. The share of that correction which contacts feel as motion, and
    /// how much of the rest the anchors of friction know of.
    double taken{0.0};
    double blend{1.0 / 60.0};
    PathOffset offset;
    double felt{1.0};
    Pose anchored{0.0, 0.0, 0.0};

    /// Memory of the estimate: velocity as the snapshot told it, times and told velocities of the snapshots
    /// before, newest first, and for translation and turning the recent sizes of its first and third
    /// differences and of the changes of the latter, and the sums that tell how late the told velocities are.
    Twist told{0.0, 0.0, 0.0};
    std::int32_t past_count{0};
    std::array<PastVelocity, k_past_velocities> past;
    std::array<double, 2> slope_size{0.0, 0.0};
    std::array<double, 2> third_size{0.0, 0.0};
    std::array<double, 2> third_change{0.0, 0.0};
    std::array<double, 2> late_sum{0.0, 0.0};
    std::array<double, 2> late_weight{0.0, 0.0};

    /// Time share of the fade that is done, 0 (absent) to 1 (all there), and its direction.
    double presence{1.0};
    bool leaving{false};
    /// Loop-clock time at which a leaver was no longer listed, s.
    double left{0.0};
};

} // namespace haptics
