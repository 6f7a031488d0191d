/// Poses and velocities of the bodies, from the base outwards.
///
/// With
/// R_p the parent's rotation, the body's origin is o_s = o_p + d, d = R_p r_s (+ q R_p a_s for a prismatic
/// joint), its velocity v_s = v_p + w_p d' (+ q' R_p a_s), where d' is d turned by 90 degrees.
/// Differentiating once more with zero joint accelerations gives the bias b_s = b_p - w_p^2 d (+ 2 w_p q'
/// (R_p a_s)').

#include <haptics/core/dynamics/kinematics.hpp>

namespace haptics {
void update_positions(const LinkageModel& model, LinkageData& data) {
    for (int slot = 1; slot <= model.body_count; ++slot) {
        const BodyModel& body = model.body[slot];
        const int parent = body.parent;
        if (body.joint == BodyJoint::floating) {
            data.x[slot] = data.position[0];
            data.y[slot] = data.position[1];
            data.velocity_x[slot] = data.velocity[0];
            data.velocity_y[slot] = data.velocity[1];
            continue;
        }
        const double c = data.cosine[parent];
        const double s = data.sine[parent];
        double arm_x = c * body.origin.x() - s * body.origin.y();
        double arm_y = s * body.origin.x() + c * body.origin.y();
        double velocity_x = data.velocity_x[parent];
        double velocity_y = data.velocity_y[parent];
        if (body.joint == BodyJoint::prismatic) {
            const double axis_x = c * body.axis.x() - s * body.axis.y();
            const double axis_y = s * body.axis.x() + c * body.axis.y();
            const double q = data.position[body.freedom];
            const double v = data.velocity[body.freedom];
            data.axis_x[slot] = axis_x;
            data.axis_y[slot] = axis_y;
            arm_x += q * axis_x;
            arm_y += q * axis_y;
            velocity_x += v * axis_x;
            velocity_y += v * axis_y;
        }
        data.arm_x[slot] = arm_x;
        data.arm_y[slot] = arm_y;
        data.x[slot] = data.x[parent] + arm_x;
        data.y[slot] = data.y[parent] + arm_y;
        data.velocity_x[slot] = velocity_x - data.rate[parent] * arm_y;
        data.velocity_y[slot] = velocity_y + data.rate[parent] * arm_x;
    }
}

void update_bias(const LinkageModel& model, LinkageData& data) {
    for (int slot = 1; slot <= model.body_count; ++slot) {
        const BodyModel& body = model.body[slot];
        const int parent = body.parent;
        if (body.joint == BodyJoint::floating) {
            data.bias_x[slot] = 0.0;
            data.bias_y[slot] = 0.0;
            continue;
        }
        const double rate = data.rate[parent];
        double bias_x = data.bias_x[parent] - rate * rate * data.arm_x[slot];
        double bias_y = data.bias_y[parent] - rate * rate * data.arm_y[slot];
        if (body.joint == BodyJoint::prismatic) {
            const double twice = 2.0 * rate * data.velocity[body.freedom];
            bias_x -= twice * data.axis_y[slot];
            bias_y += twice * data.axis_x[slot];
        }
        data.bias_x[slot] = bias_x;
        data.bias_y[slot] = bias_y;
    }
}

void update_kinematics(const LinkageModel& model, LinkageData& data) {
    update_rotations(model, data);
    update_positions(model, data);
    update_bias(model, data);
}

Pose link_pose(const LinkageModel& model, const LinkageData& data, int link) {
    const LinkModel& part = model.link[link];
    const int slot = part.slot;
    const double c = data.cosine[slot];
    const double s = data.sine[slot];
    return {data.x[slot] + c * part.origin.x() - s * part.origin.y(),
            data.y[slot] + s * part.origin.x() + c * part.origin.y(), data.angle[slot] + part.angle};
}

Vec2 link_point(const LinkageModel& model, const LinkageData& data, int link, const Vec2& local) {
    const LinkModel& part = model.link[link];
    const int slot = part.slot;
    const Vec2 in_body = part.origin + Vec2(part.cosine * local.x() - part.sine * local.y(),
                                            part.sine * local.x() + part.cosine * local.y());
    const double c = data.cosine[slot];
    const double s = data.sine[slot];
    return {data.x[slot] + c * in_body.x() - s * in_body.y(),
            data.y[slot] + s * in_body.x() + c * in_body.y()};
}

Pose link_center_pose(const LinkageModel& model, const LinkageData& data, int link) {
    const LinkModel& part = model.link[link];
    const Vec2 center = link_point(model, data, link, part.center);
    return {center.x(), center.y(), data.angle[part.slot] + part.angle};
}

Twist point_velocity(const LinkageModel& model, const LinkageData& data, int link, const Vec2& point) {
    const int slot = model.link[link].slot;
    const double rate = data.rate[slot];
    return {data.velocity_x[slot] - rate * (point.y() - data.y[slot]),
            data.velocity_y[slot] + rate * (point.x() - data.x[slot]), rate};
}

Twist point_bias(const LinkageModel& model, const LinkageData& data, int link, const Vec2& point) {
    const int slot = model.link[link].slot;
    const double square = data.rate[slot] * data.rate[slot];
    return {data.bias_x[slot] - square * (point.x() - data.x[slot]),
            data.bias_y[slot] - square * (point.y() - data.y[slot]), 0.0};
}

} // namespace haptics
