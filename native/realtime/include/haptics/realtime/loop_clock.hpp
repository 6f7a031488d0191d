#pragma once
/// The clock of the loop thread, for whoever stamps data that the loop will read.

#include <cstdint>

namespace haptics {

/// CLOCK_MONOTONIC now (ns). Any thread; no system call on common machines, no allocation, no lock.
[[nodiscard]] std::int64_t loop_clock_ns() noexcept;

} // namespace haptics
