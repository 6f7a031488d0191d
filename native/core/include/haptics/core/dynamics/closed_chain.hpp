#pragma once
/// Forward dynamics of grounded revolute chains of 1 to 4 bodies in closed form. After update_rotations().

#include <haptics/core/dynamics/linkage_data.hpp>

namespace haptics {

/// acceleration = D^-1 (force - C - G); for models whose kernel is closed_chain.
void closed_chain_acceleration(const LinkageModel& model, const LinkageData& data, const LinkageVector& force,
                               LinkageVector& acceleration);
/// One semi-implicit step of dt (s): `acceleration` from the state before it, then velocity, then position.
/// Reads position and velocity alone; rotations and positions of the bodies are stale afterwards.
void closed_chain_step(const LinkageModel& model, LinkageData& data, const LinkageVector& force, double dt,
                       LinkageVector& acceleration);

} // namespace haptics
