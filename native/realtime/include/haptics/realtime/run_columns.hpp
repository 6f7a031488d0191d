#pragma once
/// The columns of run.csv: one row a haptic step, SI units in the names.

#include <haptics/core/control/report.hpp>

#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace haptics {

inline constexpr std::size_t k_run_columns = 45;

/// Names in order; the first is t_s.
const std::vector<std::string>& run_column_names();

/// The row of a report. Allocation-free.
void fill_run_row(const HapticReport& report, std::array<double, k_run_columns>& row) noexcept;

} // namespace haptics
