#pragma once
/// Forward dynamics of long serial revolute chains, grounded or floating, in four lanes. After
/// update_rotations().

#include <haptics/core/dynamics/linkage_data.hpp>

namespace haptics {

/// acceleration = D^-1 (force - C - G); for models with is_chain and at least k_split_chain_minimum bodies.
void split_chain_acceleration(const LinkageModel& model, const LinkageData& data, const LinkageVector& force,
                              LinkageVector& acceleration);

/// Lays the chain out in lanes; called by build_model().
void describe_split_chain(LinkageModel& model);

} // namespace haptics
