#pragma once
/// From a wrench at the handle to joint torques, with the least torque when there are more motors than
/// freedoms.

#include <haptics/core/pantograph/kinematics.hpp>

namespace haptics {

/// Joint torques that give `scale` times the wanted wrench.
struct TorqueSolution {
    /// Joint torques, N m, each within its limit.
    JointVector torque{JointVector::Zero()};
    /// Share of the wanted wrench that is given, 0 to 1: below 1 when the motors cannot give it all, 0 at a
    /// singularity.
    double scale{0.0};
};

/// Torques within the motors' limits for `wrench` (N, N, N m) at a located pose; the torque of a two-freedom
/// device is left out. Least 2-norm of torque over limit among all that stay within limits; when none does,
/// the whole wrench is scaled down to the largest that fits. Finite for every input; a wrench that is not
/// finite gives zero.
TorqueSolution joint_torques(const PantographKinematics& kinematics, const PantographState& state,
                             const Wrench& wrench);

} // namespace haptics
