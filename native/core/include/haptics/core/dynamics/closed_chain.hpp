#pragma once
/// Forward dynamics of grounded revolute chains of 1 to 4 bodies in closed form. After update_rotations().

#include <haptics/core/dynamics/linkage_data.hpp>

namespace haptics {

/// acceleration = D^-1 (force - C - G); for models whose kernel is closed_chain.
void closed_chain_acceleration(const LinkageModel& model, const LinkageData& data, const JointVector& force,
                               JointVector& acceleration);

} // namespace haptics
