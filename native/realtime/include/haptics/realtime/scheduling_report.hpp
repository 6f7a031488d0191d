#pragma once
/// What a loop asked the system for, what it was really granted, and what to do about the rest.

#include <cstdint>
#include <string>

namespace haptics {

/// One wish and its outcome.
struct Grant {
    /// It was asked for.
    bool asked{false};
    /// It was asked for and granted.
    bool granted{false};
    /// errno of the refusal; 0 without one.
    int error{0};

    /// False when it was asked for and refused.
    [[nodiscard]] bool satisfied() const { return granted || !asked; }
};

/// Filled when a loop starts. Main thread.
struct SchedulingReport {
    /// Why the loop did not start at all: what, the value, the fix. Empty when it started.
    std::string failure;
    /// Steps a second (Hz).
    double rate_hz{0.0};
    /// Period (ns).
    std::int64_t period_ns{0};
    /// SCHED_FIFO.
    Grant fifo;
    /// SCHED_FIFO priority asked for, after the cut to k_max_priority; 0 when ordinary scheduling was asked
    /// for.
    int priority{0};
    /// Pages stay in memory.
    Grant memory;
    /// The process may lock this much memory (bytes); -1 without a limit.
    std::int64_t memory_limit_bytes{-1};
    /// Shallow processor sleep only.
    Grant cpu_latency;
    /// The loop stays on one processor.
    Grant affinity;
    /// That processor; -1 without one.
    int cpu{-1};
    /// The system takes the processor from a runaway real-time thread for a part of each second.
    bool throttling{true};

    /// Everything asked for was granted.
    [[nodiscard]] bool complete() const;
    /// Readable lines, one a wish: granted, or why not and the fix. Allocates; main thread.
    [[nodiscard]] std::string describe() const;
    /// One line: "SCHED_FIFO 80, memory locked, cpu latency 0"; what was refused is named as "no ...".
    [[nodiscard]] std::string summary() const;
};

} // namespace haptics
