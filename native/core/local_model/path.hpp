#pragma once
// Where a neighbor that the scene moves is between two snapshots.

#include <haptics/core/local_model/track.hpp>

namespace haptics::local {

struct PathPoint {
    Pose pose;
    Twist velocity;
    Vec3 acceleration;
};

// Refines the derivatives at the track's snapshot by those of the track before; both have the same body.
void estimate(const Track& before, Track& track);

// The snapshot extrapolated to `time`, without the offset.
PathPoint extrapolated(const Track& track, double time);

// Where the body is shown at `time`.
PathPoint shown(const Track& track, double time);

// How long the path of `track`, which follows that of `before`, takes to join it, s.
double blend_time(const Track& before, const Track& track);

// Lets the path go on from `from` at the time the snapshot was taken.
void join(const PathPoint& from, Track& track);

} // namespace haptics::local
