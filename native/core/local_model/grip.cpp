// The grip of a rigid tool: point r in body axes, held in position (2 rows) or in position and angle (3
// rows). v_grip = v + omega x r, so J_h = [1 0 -r_y; 0 1 r_x; 0 0 1]; a force (F, tau) about the center of
// mass c has the torque tau - r x F about the grip.

#include "internal.hpp"

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

namespace local {

Mat3 grip_jacobian(const Grip& grip, const Pose& pose) {
    const Vec2 r = rotate(pose.z(), grip.point);
    Mat3 j = Mat3::Identity();
    j(0, 2) = -r.y();
    j(1, 2) = r.x();
    if (!grip.pose)
        j(2, 2) = 0.0;
    return j;
}

Wrench about_grip(const Grip& grip, const Pose& pose, const Wrench& about_center) {
    const Vec2 r = rotate(pose.z(), grip.point);
    return {about_center.x(), about_center.y(), about_center.z() - cross(r, about_center.head<2>())};
}

} // namespace local
} // namespace haptics
