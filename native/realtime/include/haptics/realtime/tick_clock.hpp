#pragma once
/// When a physics tick happened, without the jitter of the frames that carry it.
///
/// An engine runs its ticks in frames: two in one frame, none in the next. The state of a tick belongs to the
/// tick's own, even time line, so stamping it with the clock of the moment makes a moving body seem to jump
/// by its speed times the jitter. This clock advances by a tick's length T at each tick. All ticks of a frame
/// are handled together, and only the last of them is about as late as ticks are when no frame is; so between
/// two frames the clock leans towards the real one by how late that last one was:
///     t <- t + gain (now - t),  and at each tick  t <- t + T.
/// So jitter is damped to about gain of its size and a steady difference of rate is followed. A frame that
/// comes late brings the ticks that were due meanwhile, and its last one is in time; a tick that was itself
/// held up is followed by a frame that does. So of the last two frames the one counts that ended nearer to
/// the real clock, and none where one ended late and the other early.
///
/// An engine runs at most so many ticks in a frame and loses what was due beyond them: the time line goes on
/// so much later that the last tick of such a frame is in time. A clock that started anew at the first of
/// them would stamp the others ahead of the present, and every body would seem to be set back. Whatever comes
/// otherwise shows at the frames that follow: a clock that two of them left behind by more than
/// `k_stall_ticks`, or that runs ahead by more than a tick, starts anew.

#include <cmath>
#include <cstdint>

namespace haptics {

/// One scene's ticks. One thread; no allocation.
class TickClock {
  public:
    /// Share of the difference to the real clock that is taken between two frames.
    static constexpr double k_gain = 0.05;
    /// A difference of more ticks than this, once a frame is done, is a stall or a change of rate.
    static constexpr double k_stall_ticks = 3.0;

    /// The time (s, on the clock of `now`) of a tick of length `tick` (s, > 0) that is handled at `now` in
    /// the engine's frame number `frame`, which brings at most `most` ticks (> 0).
    double tick(double now, double tick, std::int64_t frame, int most = 8) noexcept {
        const bool new_frame = frame != frame_;
        frame_ = frame;
        if (!running_) {
            running_ = true;
            time_ = now;
            late_ = before_ = 0.0;
            return time_;
        }
        if (new_frame) {
            const double nearer = std::abs(late_) < std::abs(before_) ? late_ : before_;
            const double lean = late_ * before_ > 0.0 ? nearer : 0.0;
            const bool stalled = std::abs(lean) > k_stall_ticks * tick;
            time_ += stalled ? lean : k_gain * lean;
            before_ = stalled ? 0.0 : late_;
        }
        time_ += tick;
        late_ = now - time_;
        if (late_ > most * tick)
            time_ = now - (most - 1) * tick;
        else if (late_ < -tick)
            time_ = now;
        late_ = now - time_;
        return time_;
    }
    /// The next tick starts anew.
    void reset() noexcept { running_ = false; }

  private:
    double time_{0.0};
    /// How late the last tick was handled, and the last one of the frame before, s.
    double late_{0.0};
    double before_{0.0};
    std::int64_t frame_{0};
    bool running_{false};
};

} // namespace haptics
