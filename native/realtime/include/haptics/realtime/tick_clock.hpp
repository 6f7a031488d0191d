#pragma once
/// When a physics tick happened, without the jitter of the frames that carry it.
///
/// An engine runs its ticks in frames: two in one frame, none in the next. The state of a tick belongs to the
/// tick's own, even time line, so stamping it with the clock of the moment makes a moving body seem to jump
/// by its speed times the jitter. This clock advances by a tick's length at each tick and leans slowly
/// towards the real clock:
///     t <- t + T;  t <- t + gain (now - t)
/// so jitter is damped to about gain of its size and a steady difference of rate is followed. After a stall
/// it starts anew.

#include <cmath>

namespace haptics {

/// One scene's ticks. One thread; no allocation.
class TickClock {
  public:
    /// Share of the difference to the real clock that is taken at each tick.
    static constexpr double k_gain = 0.05;
    /// A difference of more ticks than this is a stall or a change of rate.
    static constexpr double k_stall_ticks = 3.0;

    /// The time (s, on the clock of `now`) of a tick of length `tick` (s, > 0) that is handled at `now`.
    double tick(double now, double tick) noexcept {
        time_ += tick;
        const double late = now - time_;
        if (!running_ || std::abs(late) > k_stall_ticks * tick) {
            time_ = now;
            running_ = true;
            return time_;
        }
        time_ += k_gain * late;
        return time_;
    }
    /// The next tick starts anew.
    void reset() noexcept { running_ = false; }

  private:
    double time_{0.0};
    bool running_{false};
};

} // namespace haptics
