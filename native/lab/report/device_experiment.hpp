#pragma once
/// Experiment 1 of the paper with the device in the loop, for the sweep.

#include <haptics/sweep/experiment.hpp>

namespace haptics::report {

[[nodiscard]] sweep::Experiment device_experiment();

} // namespace haptics::report
