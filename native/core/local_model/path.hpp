#pragma once
// Where a neighbor that the scene moves is between two snapshots.

#include <haptics/core/local_model/track.hpp>

namespace haptics::local {

// Velocity and acceleration as contacts feel them; rate and bend are the derivatives of the pose.
struct PathPoint {
    Pose pose;
    Twist velocity;
    Vec3 acceleration;
    Twist rate;
    Vec3 bend;
};

inline PathPoint moving_point(const Pose& pose, const Twist& velocity, const Vec3& acceleration) {
    return {pose, velocity, acceleration, velocity, acceleration};
}

// Refines the derivatives at the track's snapshot by those of the track before; both have the same body.
void estimate(const Track& before, Track& track);

// The snapshot extrapolated to `time`, without the offset.
PathPoint extrapolated(const Track& track, double time);

// Where the body is shown at `time`.
PathPoint shown(const Track& track, double time);

// How far the body was corrected since the snapshot was taken: what its pose has moved by beyond the velocity
// that contacts feel.
Pose corrected(const Track& track, double time);

// How long the path of `track`, which follows that of `before`, takes to join it, s.
double blend_time(const Track& before, const Track& track);

// Lets the path go on from `from` at the time the snapshot was taken, where it is at `to`.
void join(const PathPoint& from, const PathPoint& to, Track& track);

} // namespace haptics::local
