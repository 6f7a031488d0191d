#pragma once
/// A semi-implicit step of one to three bodies in few operations that wait for each other.

#include <haptics/core/dynamics/linkage_data.hpp>

namespace haptics {

/// As closed_chain_step(), for models with at most three bodies.
void short_chain_step(const LinkageModel& model, LinkageData& data, const double* force, double dt,
                      double* acceleration);

/// Fills what short_chain_step() reads from the rest of the chain's constants; called by build_model().
void describe_short_chain(LinkageModel& model);

} // namespace haptics
