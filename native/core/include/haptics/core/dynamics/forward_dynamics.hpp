#pragma once
/// Forward dynamics by the method that fits the linkage (LinkageModel::kernel).

#include <haptics/core/dynamics/articulated.hpp>

namespace haptics {

/// Refreshes from `data` what forward_dynamics() reads: rotations for the chain kernels, positions too for
/// the others.
void prepare_dynamics(const LinkageModel& model, LinkageData& data);

/// acceleration = D^-1 (force - C - G). After prepare_dynamics() or update_kinematics(). `workspace` is
/// written by the articulated kernel only; use factorize() where D^-1 is needed beside.
void forward_dynamics(const LinkageModel& model, const LinkageData& data, const LinkageVector& force,
                      ArticulatedFactor& workspace, LinkageVector& acceleration);
/// One semi-implicit step of dt (s) under a constant `force`: acceleration from the state before it, then
/// velocity, then position. Needs no refresh before it, and leaves the bodies' rotations and positions stale.
void step_semi_implicit(const LinkageModel& model, LinkageData& data, const LinkageVector& force, double dt,
                        ArticulatedFactor& workspace, LinkageVector& acceleration);

} // namespace haptics
