#pragma once
/// Movable neighbors inside the local model: what the model believes, and what it tells the environment.

#include <haptics/core/types.hpp>

#include <cstdint>

namespace haptics {

/// Movable neighbors that are integrated together with the tool; what exceeds it is treated as kinematic.
inline constexpr int k_max_movables = 16;

/// The part of a movable's state that travels to the environment in a report and comes back, unchanged, with
/// the snapshot that reflects this report. The local model compares the two and takes over only the
/// difference, so that its own, newer knowledge survives.
struct MovableBelief {
    std::uint64_t id{0};
    /// Step at which the model met the body: the counter `given` starts at zero there.
    std::uint64_t epoch{0};
    /// Loop-clock time of the belief, s.
    double time{0.0};
    /// About the center of mass, scene axes.
    Pose pose{0.0, 0.0, 0.0};
    Twist velocity{0.0, 0.0, 0.0};
    /// Corrections taken over from the environment since `epoch`: sum of those of the velocity, and what they
    /// and those of the pose have moved the body by.
    Pose corrected_pose{0.0, 0.0, 0.0};
    Twist corrected_velocity{0.0, 0.0, 0.0};
    /// Impulse and angular impulse that the tool has given to the body since `epoch` (N s, N s, N m s): a
    /// cumulative counter, so that a lost report loses no momentum.
    Wrench given{0.0, 0.0, 0.0};
};

/// A movable neighbor as the local model carries it from step to step.
struct MovableState {
    MovableBelief belief;
    /// Index in Data::neighbors; -1 when the snapshot no longer lists it.
    std::int32_t body{-1};
    /// First row of the body in the step's system; -1 when nothing joins it to the tool.
    std::int32_t row{-1};
    /// Corrections that are still to be blended in, and the time left for it, s.
    Pose pending_pose{0.0, 0.0, 0.0};
    Twist pending_velocity{0.0, 0.0, 0.0};
    double blend_left{0.0};
    /// Of `given`, what the linkage of a jointed body has received.
    Wrench passed{0.0, 0.0, 0.0};
    /// Part of the velocity that works off `pending_pose` and will be taken back.
    Twist shift_velocity{0.0, 0.0, 0.0};
    /// How far the belief is ahead of the environment, which hears of what happens here a tick later.
    /// Derivations are in native/core/local_model/movables.cpp.
    Pose lead{0.0, 0.0, 0.0};
    /// `given` and `time` of the last belief that came back, and when the body was last joined to the tool.
    Wrench heard_given{0.0, 0.0, 0.0};
    double heard_time{0.0};
    double joined_time{-1e300};
    /// Mean of the last differences of velocity from the environment, and of their sizes, m/s.
    Twist surprise{0.0, 0.0, 0.0};
    double surprise_size{0.0};
    /// While joined: how many beliefs came back, mean time since they were sent, s, and mean acceleration
    /// that the tool gives the body.
    std::int32_t heard{0};
    double lag{0.0};
    Vec3 push{0.0, 0.0, 0.0};
    /// Velocity in the last snapshot, its time, and `given` of the belief that came back with it.
    Twist seen_velocity{0.0, 0.0, 0.0};
    double seen_time{0.0};
    Wrench seen_given{0.0, 0.0, 0.0};
    /// Sizes of the last changes of the environment's velocity beyond what it was told and its fall, and of
    /// these two, m/s: the less odd, the surer that it moves the body by these alone.
    double odd_change{1.0};
    double known_change{1.0};
    /// The environment moves it by these alone, and nothing but the tool and others like it touches it here.
    bool free{false};
    /// Velocity along the weight that the tool bears by which the environment is to be ahead once it has
    /// heard all, and mean of what it has yet to hear, m/s.
    double lift{0.0};
    double mean_untold{0.0};
    /// Last step in which `given` changed.
    std::uint64_t given_step{0};
};

} // namespace haptics
