#include <haptics/realtime/loop_schedule.hpp>

namespace haptics {

LoopSchedule::LoopSchedule(std::int64_t origin_ns, std::int64_t period_ns) noexcept
    : origin_ns_(origin_ns)
    , period_ns_(period_ns)
    , due_ns_(origin_ns)
    , deadline_ns_(origin_ns + period_ns) {}

StepTime LoopSchedule::begin_step(std::int64_t now_ns) noexcept {
    // a wake so late that whole periods have gone by: the step is that of the last grid point passed
    deadline_ns_ = due_ns_ + period_ns_;
    overslept_ = (now_ns - due_ns_) / period_ns_;
    due_ns_ += overslept_ * period_ns_;
    return {.index = index_++,
            .time_ns = due_ns_ - origin_ns_,
            .clock_ns = now_ns,
            .dt = static_cast<double>(period_ns_) * 1e-9,
            .skipped = overrun_ + overslept_};
}

LoopSchedule::Outcome LoopSchedule::end_step(std::int64_t now_ns) noexcept {
    due_ns_ += period_ns_;
    overrun_ = now_ns >= due_ns_ ? (now_ns - due_ns_) / period_ns_ + 1 : 0;
    due_ns_ += overrun_ * period_ns_;
    return {now_ns >= deadline_ns_, overslept_ + overrun_};
}

} // namespace haptics
