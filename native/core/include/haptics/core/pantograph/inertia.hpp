#pragma once
/// What the moving parts of a pantograph add at the handle: mass matrix, velocity terms, gravity.

#include <haptics/core/pantograph/kinematics.hpp>

namespace haptics {

/// Mass matrix at the handle (kg, kg m, kg m^2): handle, links and rotors. Symmetric positive definite. With
/// two freedoms the rotation row holds the handle's own inertia only.
Mat3 handle_mass_matrix(const PantographKinematics& kinematics, const PantographState& state);

/// Velocity terms c of M(q) a + c = wrench at the handle, for the handle twist `twist` (N, N, N m).
Wrench velocity_wrench(const PantographKinematics& kinematics, const PantographState& state,
                       const Twist& twist);

/// Wrench that gravity (m/s^2, device frame) exerts at the handle through links and handle. Its negative
/// holds the device still.
Wrench gravity_wrench(const PantographKinematics& kinematics, const PantographState& state,
                      const Vec2& gravity);

/// Joint torques that hold the device against gravity, within limits (N m).
JointVector gravity_torque(const PantographKinematics& kinematics, const PantographState& state,
                           const Vec2& gravity);

/// Potential energy of all moving parts in `gravity`, J, zero level at the device frame's origin.
double gravity_potential(const PantographKinematics& kinematics, const Pose& pose,
                         const PantographState& state, const Vec2& gravity);

/// Joint friction as a wrench at the handle for the twist `twist` (N, N, N m): viscous and Coulomb; opposes
/// motion.
Wrench joint_friction_wrench(const PantographKinematics& kinematics, const PantographState& state,
                             const Twist& twist);

} // namespace haptics
