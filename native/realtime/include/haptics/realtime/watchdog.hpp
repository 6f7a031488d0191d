#pragma once
/// Fades forces out when what the loop knows has become old, and softly back in when news come again.

#include <cstdint>

namespace haptics {

/// Times of a watchdog (s). 0 <= fade_begins <= fade_ends.
struct WatchdogTimes {
    /// Up to this age the factor is 1: two late ticks of a slow scene.
    double fade_begins{0.1};
    /// From this age on the factor is 0.
    double fade_ends{0.15};
    /// Time that the way back from 0 to 1 takes at least; 0 or less comes back at once.
    double comes_back{0.3};
};

/// Age (s) at `clock_ns` of news stamped `stamp_ns` on the same clock; news from the future are new (0).
[[nodiscard]] double age_s(std::int64_t clock_ns, std::int64_t stamp_ns) noexcept;

/// The factor that an age alone asks for: 1 up to fade_begins, 0 from fade_ends, straight between; 0 for NaN.
[[nodiscard]] double watchdog_target(const WatchdogTimes& times, double age_s) noexcept;

/// Follows watchdog_target() downwards at once and upwards at most by dt / comes_back. Loop thread; no
/// allocation, pure in its arguments and its own state.
class Watchdog {
  public:
    /// Starts at factor 0, so that a loop's first news come in softly too.
    explicit Watchdog(const WatchdogTimes& times = {}) noexcept
        : times_(times) {}

    /// The factor (0..1) for forces in a step of `dt` s that sees news of this age.
    double step(double age_s, double dt) noexcept;
    /// The factor of the last step, 0..1: level^2 (3 - 2 level), so that it leaves and reaches its ends
    /// without a kink.
    [[nodiscard]] double factor() const noexcept;
    /// News were too old in the last step.
    [[nodiscard]] bool expired() const noexcept { return expired_; }
    /// Times that news became too old (once for each stall), the beginning not counted.
    [[nodiscard]] std::uint64_t stalls() const noexcept { return stalls_; }

  private:
    WatchdogTimes times_;
    double level_{0.0};
    bool expired_{false};
    std::uint64_t stalls_{0};
};

} // namespace haptics
