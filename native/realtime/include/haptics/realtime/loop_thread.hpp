#pragma once
/// A thread that runs a step at a fixed rate, as punctually as the system permits.
///
/// It sleeps until absolute times on a grid of periods (CLOCK_MONOTONIC), so lateness does not add up. A step
/// or wake that runs into the next periods costs those periods: the loop goes on at the next grid point and
/// tells the step how many were left out. It never runs steps in a burst.

#include <haptics/realtime/histogram.hpp>
#include <haptics/realtime/loop_options.hpp>
#include <haptics/realtime/loop_statistics.hpp>
#include <haptics/realtime/loop_step.hpp>
#include <haptics/realtime/process_grants.hpp>
#include <haptics/realtime/scheduling_report.hpp>

#include <pthread.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <string>

namespace haptics {

/// One periodic thread. Its owner (one thread, usually the main one) starts and stops it; each method says
/// who else may call it.
class LoopThread {
  public:
    LoopThread() = default;
    LoopThread(const LoopThread&) = delete;
    LoopThread& operator=(const LoopThread&) = delete;
    /// Stops and joins.
    ~LoopThread();

    /// Owner: starts the thread and returns when it stands with all it was granted (see report()). False when
    /// it could not start; report().failure says why. A loop that already runs goes on unchanged, and the
    /// answer is true. Statistics begin anew. Allocates, locks.
    bool start(LoopStep& step, const LoopOptions& options = {});

    /// Owner: ends the loop after the step under way, waits for the thread to be gone, gives back what was
    /// granted. Takes at most a period and a step. Does nothing when no loop runs. Called from within a step
    /// (which cannot wait for itself) it only requests the stop.
    void stop() noexcept;

    /// Any thread, also from within a step: the loop ends before its next step. Wait-free. stop() is still
    /// needed.
    void request_stop() noexcept { stop_requested_.store(true, std::memory_order_release); }

    /// Any thread: the loop is stepping. False before start(), after stop(), and once a request or an
    /// exception has ended it.
    [[nodiscard]] bool running() const noexcept { return running_.load(std::memory_order_acquire); }

    /// Owner: the exception that ended the loop, or nothing. Stays until the next start().
    [[nodiscard]] std::string failure() const;

    /// Owner: what the last start() was granted.
    [[nodiscard]] const SchedulingReport& report() const noexcept { return report_; }

    /// Any thread but the loop's own: counts since the last start(); they stay after stop().
    [[nodiscard]] LoopStatistics statistics() const noexcept;

  private:
    static void* entry(void* self) noexcept;
    void prepare() noexcept;
    void run() noexcept;
    bool run_step(const StepTime& time) noexcept;
    void keep_failure(const char* what) noexcept;

    LoopOptions options_;
    SchedulingReport report_;
    LoopStep* step_{nullptr};
    pthread_t thread_{};
    bool joinable_{false};
    ProcessGrants grants_;
    std::array<char, 256> failure_{};
    std::atomic<bool> failed_{false};
    std::atomic<bool> stop_requested_{false};
    std::atomic<bool> running_{false};
    std::atomic<bool> prepared_{false};
    std::atomic<std::uint64_t> steps_{0};
    std::atomic<std::uint64_t> missed_deadlines_{0};
    std::atomic<std::uint64_t> skipped_periods_{0};
    Histogram wake_latency_;
    Histogram step_time_;
};

} // namespace haptics
