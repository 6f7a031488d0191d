#pragma once
/// Step times driven by hand instead of by a thread: the same loop code, bit-for-bit repeatable.

#include <haptics/realtime/step_time.hpp>

#include <cstdint>

namespace haptics {

/// Turns environment ticks into haptic steps. Time is kept in whole nanoseconds and the fraction of one that
/// a tick leaves is carried on, so 60 ticks of 1/60 s are one second, and neither sum drifts. One thread; no
/// allocation.
///
///     clock.advance(delta, [&](const StepTime& time) { step.step(time); });
class LockstepClock {
  public:
    /// Longest tick (s); a longer one counts as this long, so that a stalled scene does not run a million
    /// steps.
    static constexpr double k_longest_tick_s = 1.0;

    /// `rate_hz` must be valid (is_valid_lockstep_rate), otherwise the default rate is taken.
    explicit LockstepClock(double rate_hz = k_default_rate_hz) noexcept;

    /// The scene moves on by `duration_s` (>= 0; NaN and negative count as 0). Returns how many steps are now
    /// due: call next() as often. Steps not yet taken stay due.
    [[nodiscard]] int begin_tick(double duration_s) noexcept;
    /// The time of the next step. Its clock_ns is its time_ns.
    [[nodiscard]] StepTime next() noexcept;

    /// Time of the scene (ns): the sum of all ticks, rounded to nearest. The clock that snapshots are stamped
    /// with.
    [[nodiscard]] std::int64_t scene_ns() const noexcept { return scene_ns_; }
    /// The same in seconds.
    [[nodiscard]] double time() const noexcept { return static_cast<double>(scene_ns_) * 1e-9; }
    /// begin_tick(), then `run(const StepTime&)` for every step due. Returns how many.
    template <typename Run>
    int advance(double duration_s, Run&& run) {
        const int due = begin_tick(duration_s);
        for (int i = 0; i < due; ++i) {
            run(next());
        }
        return due;
    }
    /// Back to zero.
    void reset() noexcept;

  private:
    std::int64_t period_ns_;
    std::int64_t scene_ns_{0};
    double fraction_ns_{0.0};
    std::int64_t steps_{0};
};

} // namespace haptics
