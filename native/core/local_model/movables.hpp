#pragma once
// Movable neighbors: meeting them, believing about them, and taking over what the environment knows better.

#include <haptics/core/local_model/data.hpp>

namespace haptics::local {

// Takes over what the snapshot says of the movables among its first `listed` neighbors. The tracks tell where
// those that were no movables until now were shown.
void take_movables(const Neighborhood& n, Data& data);

// Moves movables that nothing joins to the tool, and blends corrections in.
void move_movables(Data& data, double dt);

// Compares how the environment changed the body's velocity since the last snapshot with what it was told.
void watch_answer(const Body& seen, const MovableBelief& echo, const Neighborhood& n, MovableState& m);

// Takes in that the environment has yet to hear of `untold` m/s of the weight that the tool bears; `fall` is
// gravity, m/s^2.
void hear(double untold, double tick, double fall, MovableState& m);

// Brings the environment up to what the tool bears, see carried.cpp.
void lift_carried(Data& data, double dt);

// With what acceleration the environment lets the body fall where nothing holds it: scenes tell that of the
// tool, and of each body what it has more.
inline Vec2 fall_of(const Vec2& gravity, const Body& body) {
    return gravity + body.acceleration.head<2>();
}

// Corrections of the pose and of the velocity.
inline void add_pose(MovableState& m, const Pose& pose) {
    m.belief.pose += pose;
    m.belief.corrected_pose += pose;
}
inline void add_velocity(MovableState& m, const Twist& velocity) {
    m.belief.velocity += velocity;
    m.belief.corrected_velocity += velocity;
}

} // namespace haptics::local
