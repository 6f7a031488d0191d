// The grip: point r of the held link (of the rigid tool), from its center of mass, in its axes.

#include <haptics/core/dynamics/mass_matrix.hpp>
#include <haptics/core/local_model/local_model.hpp>

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

Vec3 free_grip_acceleration(const Model& model, Data& data) {
    Vec3 result;
    if (model.tool.articulated) {
        ContactSystem& s = data.system;
        s.tool_freedoms = model.tool.freedoms();
        local::write_tool_force(model, data);
        s.tool_force = s.external.head(s.tool_freedoms);
        const Vec3 forced = local::tool_response(model, data, s.tool_force);
        result = forced + local::grip_bias(model, data);
        local::place_tool(model, data);
    } else {
        result = local::grip_bias(model, data) + Vec3(data.gravity.x(), data.gravity.y(), 0.0);
    }
    if (!data.grip.pose)
        result.z() = 0.0;
    return result;
}

} // namespace haptics
