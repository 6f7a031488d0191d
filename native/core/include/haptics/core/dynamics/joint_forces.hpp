#pragma once
/// Passive forces of the joints: springs, damping, smooth Coulomb friction, limits as spring-dampers.

#include <haptics/core/dynamics/linkage_data.hpp>

namespace haptics {

/// force += springs + damping + friction + limits (N m or N).
/// Friction is -friction * clamp(rate / friction_band, -1, 1): it creeps below the band. A limit never pulls.
void add_joint_forces(const LinkageModel& model, const LinkageData& data, LinkageVector& force);

/// The same forces for a linearly implicit step of `dt` (s): with B and K the slopes of the forces in rate
/// and position, force += f(q, q') - dt K q', and added = dt B + dt^2 K is the diagonal to be added to the
/// mass matrix. Stable for any stiffness.
void add_joint_forces_implicit(const LinkageModel& model, const LinkageData& data, double dt,
                               LinkageVector& force, LinkageVector& added);

} // namespace haptics
