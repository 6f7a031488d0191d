#include <haptics/core/dynamics/energy.hpp>

#include <cmath>

namespace haptics {
namespace {

/// Center of mass of a body relative to its origin, scene axes.
Vec2 center_arm(const LinkageModel& model, const LinkageData& data, int slot) {
    const Vec2& center = model.body[slot].center;
    return {data.cosine[slot] * center.x() - data.sine[slot] * center.y(),
            data.sine[slot] * center.x() + data.cosine[slot] * center.y()};
}

Vec2 center_velocity(const LinkageData& data, int slot, const Vec2& arm) {
    return Vec2(data.velocity_x[slot], data.velocity_y[slot]) + data.rate[slot] * perpendicular(arm);
}

} // namespace

double kinetic_energy(const LinkageModel& model, const LinkageData& data) {
    double twice = 0.0;
    for (int slot = 1; slot <= model.body_count; ++slot) {
        const Vec2 velocity = center_velocity(data, slot, center_arm(model, data, slot));
        twice += model.body[slot].mass * velocity.squaredNorm() +
                 model.body[slot].inertia * data.rate[slot] * data.rate[slot];
    }
    return 0.5 * twice;
}

double potential_energy(const LinkageModel& model, const LinkageData& data) {
    double energy = 0.0;
    for (int slot = 1; slot <= model.body_count; ++slot) {
        const Vec2 center = Vec2(data.x[slot], data.y[slot]) + center_arm(model, data, slot);
        energy -= model.body[slot].mass * model.gravity.dot(center);
    }
    for (int i = model.floating ? 3 : 0; i < model.freedoms; ++i) {
        const JointSpec& joint = model.passive[i];
        const double stretch = data.position[i] - joint.spring_rest;
        energy += 0.5 * joint.spring_stiffness * stretch * stretch;
        const double beyond = std::fmax(
            0.0, std::fmax(joint.lower_limit - data.position[i], data.position[i] - joint.upper_limit));
        energy += 0.5 * joint.limit_stiffness * beyond * beyond;
    }
    return energy;
}

Momentum total_momentum(const LinkageModel& model, const LinkageData& data) {
    Momentum total;
    for (int slot = 1; slot <= model.body_count; ++slot) {
        const Vec2 arm = center_arm(model, data, slot);
        const Vec2 linear = model.body[slot].mass * center_velocity(data, slot, arm);
        total.linear += linear;
        total.angular += model.body[slot].inertia * data.rate[slot] +
                         cross(Vec2(data.x[slot], data.y[slot]) + arm, linear);
    }
    return total;
}

} // namespace haptics
