#pragma once
// The grip of a rigid tool: J_h = [1 0 -r_y; 0 1 r_x; 0 0 t] with the lever r from the center of mass in
// scene axes, and t = 1 where the angle is held, else 0.

#include <haptics/core/local_model/local_model.hpp>

namespace haptics::local {

struct RigidGrip {
    Vec2 lever;
    bool pose;

    // J_h v
    [[nodiscard]] Vec3 velocity(const Vec3& v) const {
        return {v.x() - lever.y() * v.z(), v.y() + lever.x() * v.z(), pose ? v.z() : 0.0};
    }
    // J_h' f
    [[nodiscard]] Vec3 wrench(const Vec3& f) const {
        return {f.x(), f.y(), lever.x() * f.y() - lever.y() * f.x() + (pose ? f.z() : 0.0)};
    }
    // J_h D^-1 J_h'
    [[nodiscard]] Mat3 mobility(double mass, double inertia) const {
        const double turn = 1.0 / inertia;
        const double x = -lever.y() * turn;
        const double y = lever.x() * turn;
        const double held = pose ? 1.0 : 0.0;
        Mat3 m;
        m(0, 0) = 1.0 / mass - lever.y() * x;
        m(1, 1) = 1.0 / mass + lever.x() * y;
        m(2, 2) = held * turn;
        m(1, 0) = m(0, 1) = lever.x() * x;
        m(2, 0) = m(0, 2) = held * x;
        m(2, 1) = m(1, 2) = held * y;
        return m;
    }
};

// Adds the coupling over dt to the equation base v+ = right of integrate.cpp; `at` is the pose of the grip.
inline void couple_rigid(const RigidGrip& grip, const Pose& at, const HandInput& hand, double dt, double left,
                         Mat3& base, Vec3& right) {
    const Pose target = hand.target - left * hand.target_velocity;
    const Vec3 k = dt * (dt * hand.stiffness + hand.damping);
    const Vec3 push = dt * (hand.stiffness.cwiseProduct(target - at) +
                            hand.damping.cwiseProduct(hand.target_velocity) + hand.force);
    const Vec2 across(-grip.lever.y() * k.x(), grip.lever.x() * k.y());
    base(0, 0) += k.x();
    base(1, 1) += k.y();
    base(2, 0) += across.x();
    base(0, 2) += across.x();
    base(2, 1) += across.y();
    base(1, 2) += across.y();
    base(2, 2) += grip.lever.x() * across.y() - grip.lever.y() * across.x() + (grip.pose ? k.z() : 0.0);
    right += grip.wrench(push);
}

// Mean force of the coupling over a step that ends with the velocity v; `at` is the pose of the grip.
inline Wrench coupling_of_rigid(const RigidGrip& grip, const Pose& at, const HandInput& hand, double dt,
                                const Vec3& v) {
    const Vec3 rate = grip.velocity(v);
    const Vec3 distance = hand.target - at - grip.velocity(dt * v);
    Wrench force =
        hand.stiffness.cwiseProduct(distance) + hand.damping.cwiseProduct(hand.target_velocity - rate);
    if (!grip.pose)
        force.z() = 0.0;
    return force;
}

} // namespace haptics::local
