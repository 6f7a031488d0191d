#pragma once
/// Which grid point a loop wakes at next: the overrun policy, apart from the thread so that it can be tested
/// without one.

#include <haptics/realtime/step_time.hpp>

#include <cstdint>

namespace haptics {

/// The grid origin, origin + period, origin + 2 period ... of wakes (ns on the loop clock). A late wake or a
/// long step costs the grid points that have passed; they are counted, never made up for. Loop thread;
/// wait-free, no allocation.
class LoopSchedule {
  public:
    /// How a step came out.
    struct Outcome {
        /// It ended at or after the wake that followed the one it was due at.
        bool missed;
        /// Grid points left out because of its late wake or its late end.
        std::int64_t skipped;
    };

    /// First wake at `origin_ns`; `period_ns` > 0.
    LoopSchedule(std::int64_t origin_ns, std::int64_t period_ns) noexcept;

    /// The next wake (ns).
    [[nodiscard]] std::int64_t due_ns() const noexcept { return due_ns_; }
    /// The loop woke at `now_ns` >= due_ns(): the time of the step that begins.
    [[nodiscard]] StepTime begin_step(std::int64_t now_ns) noexcept;
    /// The step ended at `now_ns`; due_ns() is then the first grid point after that, at least one period on.
    Outcome end_step(std::int64_t now_ns) noexcept;

  private:
    std::int64_t origin_ns_;
    std::int64_t period_ns_;
    std::int64_t due_ns_;
    std::int64_t deadline_ns_;
    std::int64_t overslept_{0};
    std::int64_t overrun_{0};
    std::int64_t index_{0};
};

} // namespace haptics
