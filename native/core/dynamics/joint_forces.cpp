/// Force of one joint: f = -k_s (q - rest) - b q' - c clamp(q'/band, -1, 1) + limit, where the limit beyond
/// its stop by p > 0 pushes back with max(0, k_l p - b_l p'). Linearly implicit: f(q + dt q'_new, q'_new) is
/// expanded at (q, q'), q'_new = q' + dt a, so that (D + dt B + dt^2 K) a = force(q, q') - dt K q', with B =
/// -df/dq' and K = -df/dq.

#include <haptics/core/dynamics/joint_forces.hpp>

#include <algorithm>
#include <cmath>

namespace haptics {
namespace {

/// Force and its slopes.
struct JointForce {
    double force{0.0};
    double stiffness{0.0};
    double damping{0.0};
};

JointForce joint_force(const JointSpec& joint, double q, double v) {
    JointForce result;
    result.force = -joint.spring_stiffness * (q - joint.spring_rest) - joint.damping * v;
    result.stiffness = joint.spring_stiffness;
    result.damping = joint.damping;
    if (joint.friction > 0.0) {
        const double share = v / joint.friction_band;
        result.force -= joint.friction * std::clamp(share, -1.0, 1.0);
        if (std::fabs(share) < 1.0) {
            result.damping += joint.friction / joint.friction_band;
        }
    }
    const bool below = q < joint.lower_limit;
    if (below || q > joint.upper_limit) {
        const double sign = below ? 1.0 : -1.0;
        const double depth = below ? joint.lower_limit - q : q - joint.upper_limit;
        const double push = joint.limit_stiffness * depth - joint.limit_damping * sign * v;
        if (push > 0.0) {
            result.force += sign * push;
            result.stiffness += joint.limit_stiffness;
            result.damping += joint.limit_damping;
        }
    }
    return result;
}

} // namespace

void add_joint_forces(const LinkageModel& model, const LinkageData& data, LinkageVector& force) {
    if (!model.has_passive) {
        return;
    }
    for (int i = model.floating ? 3 : 0; i < model.freedoms; ++i) {
        force[i] += joint_force(model.passive[i], data.position[i], data.velocity[i]).force;
    }
}

void add_joint_forces_implicit(const LinkageModel& model, const LinkageData& data, double dt,
                               LinkageVector& force, LinkageVector& added) {
    added.setZero(model.freedoms);
    if (!model.has_passive) {
        return;
    }
    for (int i = model.floating ? 3 : 0; i < model.freedoms; ++i) {
        const double v = data.velocity[i];
        const JointForce joint = joint_force(model.passive[i], data.position[i], v);
        force[i] += joint.force - dt * joint.stiffness * v;
        added[i] = dt * (joint.damping + dt * joint.stiffness);
    }
}

} // namespace haptics
