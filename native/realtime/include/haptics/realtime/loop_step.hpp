#pragma once
/// What the loop runs.

#include <haptics/realtime/step_time.hpp>

namespace haptics {

/// The work of a loop. It must outlive the loop that runs it.
class LoopStep {
  public:
    LoopStep() = default;
    LoopStep(const LoopStep&) = delete;
    LoopStep& operator=(const LoopStep&) = delete;
    virtual ~LoopStep() = default;

    /// One haptic step, on the loop thread (in lock-step on the caller's): no allocation, lock, log or
    /// blocking call but the device. An exception ends the loop; LoopThread::failure() then says which.
    virtual void step(const StepTime& time) = 0;
    /// Once on the loop thread, before the first step. May allocate.
    virtual void loop_begins() noexcept {}
    /// Once on the loop thread, after the last step, also when an exception ended the loop: the place to zero
    /// the force.
    virtual void loop_ends() noexcept {}
};

} // namespace haptics
