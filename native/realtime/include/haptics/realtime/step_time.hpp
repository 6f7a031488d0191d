#pragma once
/// When a haptic step happens. The same for the loop thread and for lock-step.

#include <cmath>
#include <cstdint>

namespace haptics {

/// What a step knows about time.
struct StepTime {
    /// Number of the step since the start, from 0, without gaps.
    std::int64_t index{0};
    /// Nominal time of the step since the start (ns), on the grid of periods: (index + all skipped periods) *
    /// period.
    std::int64_t time_ns{0};
    /// The loop's clock when the step began (ns): CLOCK_MONOTONIC in the thread, time_ns in lock-step. Ages
    /// of snapshots are taken on this clock.
    std::int64_t clock_ns{0};
    /// Nominal period (s). It does not grow when periods were skipped.
    double dt{0.0};
    /// Periods left out since the step before because it or the wake was late; 0 in lock-step.
    std::int64_t skipped{0};

    /// Nominal time since the start (s).
    [[nodiscard]] double time() const noexcept { return static_cast<double>(time_ns) * 1e-9; }
};

/// Slowest loop (Hz).
inline constexpr double k_min_rate_hz = 250.0;
/// Fastest loop (Hz).
inline constexpr double k_max_rate_hz = 10000.0;
/// Loop rate where nothing else is asked for (Hz).
inline constexpr double k_default_rate_hz = 1000.0;

/// Fastest lock-step (Hz): as a reference for slower loops, not for a device.
inline constexpr double k_max_lockstep_rate_hz = 100000.0;

/// True for rates that the loop accepts.
[[nodiscard]] inline bool is_valid_rate(double rate_hz) noexcept {
    return rate_hz >= k_min_rate_hz && rate_hz <= k_max_rate_hz;
}

/// True for rates that the lock-step clock accepts.
[[nodiscard]] inline bool is_valid_lockstep_rate(double rate_hz) noexcept {
    return rate_hz >= k_min_rate_hz && rate_hz <= k_max_lockstep_rate_hz;
}

/// Period (ns) of a valid rate, rounded to a whole nanosecond.
[[nodiscard]] inline std::int64_t period_ns(double rate_hz) noexcept {
    return std::llround(1e9 / rate_hz);
}

} // namespace haptics
