// Derivation.
// Every moving part is a mass at a point plus an inertia about it; with Jacobians J (twist to velocity of the
// point) and j (twist to turning rate), M = sum m J^T J + I j^T j, and the velocity terms are sum m J^T a0 +
// I j^T alpha0, where a0, alpha0 are the accelerations that remain when the handle's own acceleration is
// zero. Per leg, with row g of the rates, e, d as in kinematics.cpp:
//   driven link (share c of e):  phi' = g q',  point velocity c perp(e) g q'
//   distal link: elbow J_E = perp(e) g, end J_P = [ 1, perp(arm) ], point (1 - c) J_E + c J_P, rate psi' = d
//   x (P' - E') / L^2 rotor: gear * phi'.
// Accelerations at zero handle acceleration: a_P = -theta'^2 arm. The distal link keeps its length,
//   d . (a_P - a_E) + |P' - E'|^2 = 0 with a_E = phi'' perp(e) - phi'^2 e, gives
//   phi'' = ( d . (a_P + phi'^2 e) + |P' - E'|^2 ) / (e x d)   and   psi'' = d x (a_P - a_E) / L^2.
// Gravity: sum m J^T g. The reference point is the handle's own center of mass.

#include <haptics/core/pantograph/inertia.hpp>
#include <haptics/core/pantograph/torque_map.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace haptics {

namespace {

using Rows = Eigen::Matrix<double, 2, 3>;
using Row = Eigen::RowVector3d;

// figures and Jacobians of one leg
struct LegMotion {
    double proximal_mass;
    double distal_mass;
    double distal_inertia;
    // driven link about its own center, plus the geared rotor
    double turning_inertia;
    double proximal_center;
    double distal_center;
    double moment;
    double distal_squared;
    Row joint;
    Row distal_rate;
    Rows elbow;
    Rows end;
    Rows proximal_point;
    Rows distal_point;
};

LegMotion leg_motion(const PantographKinematics& kinematics, const PantographState& state, std::size_t i) {
    const PantographGeometry& geometry = kinematics.geometry();
    const FiveBarGeometry& bar = geometry.bar[i / 2];
    const LegState& leg = state.leg[i];
    LegMotion m;
    m.proximal_mass = bar.proximal_mass;
    m.distal_mass = bar.distal_mass;
    m.distal_inertia = bar.distal_inertia;
    m.turning_inertia =
        bar.proximal_inertia + geometry.motor.rotor_inertia * geometry.gear_ratio[i] * geometry.gear_ratio[i];
    m.proximal_center = bar.proximal_center;
    m.distal_center = bar.distal_center;
    m.moment = cross(leg.proximal, leg.distal);
    if (std::abs(m.moment) < 1.0e-9)
        m.moment = std::copysign(1.0e-9, m.moment);
    m.distal_squared = std::max(leg.distal.squaredNorm(), 1.0e-12);
    m.joint = state.rates.row(static_cast<Eigen::Index>(i));
    m.elbow = perpendicular(leg.proximal) * m.joint;
    m.end.leftCols<2>().setIdentity();
    m.end.col(2) = kinematics.freedoms() == 3 ? perpendicular(leg.arm) : Vec2(Vec2::Zero());
    m.proximal_point = m.proximal_center * m.elbow;
    m.distal_point = (1.0 - m.distal_center) * m.elbow + m.distal_center * m.end;
    m.distal_rate = perpendicular(leg.distal).transpose() * (m.end - m.elbow) / m.distal_squared;
    return m;
}

std::size_t legs(const PantographKinematics& kinematics) {
    return static_cast<std::size_t>(kinematics.motors());
}

} // namespace

Mat3 handle_mass_matrix(const PantographKinematics& kinematics, const PantographState& state) {
    const PantographGeometry& geometry = kinematics.geometry();
    Mat3 mass = Vec3(geometry.handle_mass, geometry.handle_mass, geometry.handle_inertia).asDiagonal();
    for (std::size_t i = 0; i < legs(kinematics); ++i) {
        const LegMotion m = leg_motion(kinematics, state, i);
        mass.noalias() += m.turning_inertia * m.joint.transpose() * m.joint;
        mass.noalias() += m.proximal_mass * m.proximal_point.transpose() * m.proximal_point;
        mass.noalias() += m.distal_mass * m.distal_point.transpose() * m.distal_point;
        mass.noalias() += m.distal_inertia * m.distal_rate.transpose() * m.distal_rate;
    }
    return mass;
}

Wrench velocity_wrench(const PantographKinematics& kinematics, const PantographState& state,
                       const Twist& twist) {
    Wrench wrench = Wrench::Zero();
    for (std::size_t i = 0; i < legs(kinematics); ++i) {
        const LegMotion m = leg_motion(kinematics, state, i);
        const LegState& leg = state.leg[i];
        const double turn = kinematics.freedoms() == 3 ? twist.z() : 0.0;
        const double rate = m.joint * twist;
        const Vec2 relative = (m.end - m.elbow) * twist;
        const Vec2 end = -turn * turn * leg.arm;
        const double joint =
            (leg.distal.dot(end + rate * rate * leg.proximal) + relative.squaredNorm()) / m.moment;
        const Vec2 elbow = joint * perpendicular(leg.proximal) - rate * rate * leg.proximal;
        const double distal = cross(leg.distal, end - elbow) / m.distal_squared;
        wrench += m.turning_inertia * joint * m.joint.transpose();
        wrench += m.proximal_mass * m.proximal_point.transpose() * (m.proximal_center * elbow);
        wrench += m.distal_mass * m.distal_point.transpose() *
                  ((1.0 - m.distal_center) * elbow + m.distal_center * end);
        wrench += m.distal_inertia * distal * m.distal_rate.transpose();
    }
    return wrench;
}

Wrench gravity_wrench(const PantographKinematics& kinematics, const PantographState& state,
                      const Vec2& gravity) {
    Wrench wrench(kinematics.geometry().handle_mass * gravity.x(),
                  kinematics.geometry().handle_mass * gravity.y(), 0.0);
    for (std::size_t i = 0; i < legs(kinematics); ++i) {
        const LegMotion m = leg_motion(kinematics, state, i);
        wrench += m.proximal_mass * m.proximal_point.transpose() * gravity;
        wrench += m.distal_mass * m.distal_point.transpose() * gravity;
    }
    return wrench;
}

JointVector gravity_torque(const PantographKinematics& kinematics, const PantographState& state,
                           const Vec2& gravity) {
    return joint_torques(kinematics, state, -gravity_wrench(kinematics, state, gravity)).torque;
}

double gravity_potential(const PantographKinematics& kinematics, const Pose& pose,
                         const PantographState& state, const Vec2& gravity) {
    const PantographGeometry& geometry = kinematics.geometry();
    double potential = -geometry.handle_mass * gravity.dot(pose.head<2>());
    for (std::size_t i = 0; i < legs(kinematics); ++i) {
        const FiveBarGeometry& bar = geometry.bar[i / 2];
        const LegState& leg = state.leg[i];
        const Vec2 elbow = leg.base + leg.proximal;
        potential -= bar.proximal_mass * gravity.dot(leg.base + bar.proximal_center * leg.proximal);
        potential -= bar.distal_mass * gravity.dot(elbow + bar.distal_center * leg.distal);
    }
    return potential;
}

Wrench joint_friction_wrench(const PantographKinematics& kinematics, const PantographState& state,
                             const Twist& twist) {
    const MotorFigures& motor = kinematics.geometry().motor;
    const JointVector rate = state.rates * twist;
    JointVector torque;
    // the sign is rounded off below 0.01 rad/s, so that rest is smooth
    for (int i = 0; i < k_max_motors; ++i)
        torque[i] = -motor.viscous_friction * rate[i] - motor.coulomb_friction * std::tanh(rate[i] / 0.01);
    return state.rates.transpose() * torque;
}

} // namespace haptics
