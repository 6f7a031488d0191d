#pragma once
/// How a loop has been doing.

#include <haptics/realtime/histogram.hpp>

#include <cstdint>

namespace haptics {

/// A copy taken at one moment, about 32 kB. The parts are read one after the other while the loop goes on.
struct LoopStatistics {
    /// Steps done.
    std::uint64_t steps{0};
    /// Steps that ended at or after the wake that followed the one they were due at.
    std::uint64_t missed_deadlines{0};
    /// Periods in which no step ran, because a step or a wake was late. They are left out, never made up for
    /// in a burst.
    std::uint64_t skipped_periods{0};
    /// From the time a step was due to the time it began (ns).
    HistogramSnapshot wake_latency;
    /// From the beginning of a step to its end (ns).
    HistogramSnapshot step_time;
};

} // namespace haptics
