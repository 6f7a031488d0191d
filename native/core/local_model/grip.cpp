// The grip: point r of the held link (of the rigid tool), from its center of mass, in its axes.

#include <haptics/core/local_model/local_model.hpp>

namespace haptics {

Pose grip_pose(const Grip& grip, const Pose& pose) {
    const Vec2 p = pose.head<2>() + rotate(pose.z(), grip.point);
    return {p.x(), p.y(), pose.z()};
}

Pose center_pose(const Grip& grip, const Pose& at_grip) {
    const Vec2 p = at_grip.head<2>() - rotate(at_grip.z(), grip.point);
    return {p.x(), p.y(), at_grip.z()};
}

Twist grip_velocity(const Grip& grip, const Pose& pose, const Twist& velocity) {
    const Vec2 v = velocity_at(velocity, rotate(pose.z(), grip.point));
    return {v.x(), v.y(), velocity.z()};
}

} // namespace haptics
