#pragma once
/// What to ask the system for when a loop starts.

#include <haptics/realtime/step_time.hpp>

namespace haptics {

/// Highest SCHED_FIFO priority that a loop takes: above it live the kernel's own threads, which a runaway
/// loop must not starve.
inline constexpr int k_max_priority = 80;

/// Wishes; what is not permitted is left out and told in the SchedulingReport.
struct LoopOptions {
    /// Steps a second (Hz), k_min_rate_hz..k_max_rate_hz.
    double rate_hz{k_default_rate_hz};
    /// SCHED_FIFO priority, 1..k_max_priority (more is cut to that); 0 asks for ordinary scheduling.
    int priority{k_max_priority};
    /// Keep the process's pages in memory once they were touched, while any loop runs.
    bool lock_memory{true};
    /// Hold /dev/cpu_dma_latency at 0 while the loop runs, so that the processor does not fall into sleep
    /// states which take long to leave. Costs power.
    bool hold_cpu_latency{true};
    /// Processor that the loop stays on, from 0; -1 lets the system choose.
    int cpu{-1};
};

} // namespace haptics
