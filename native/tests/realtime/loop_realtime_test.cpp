// The proof that the loop and its building blocks neither allocate, lock nor block: everything a step uses,
// on a real loop thread, with the guard on from the first step to after the last, the loop's own work between
// steps included.
#include <haptics/realtime/event_queue.hpp>
#include <haptics/realtime/latest_value.hpp>
#include <haptics/realtime/loop_thread.hpp>
#include <haptics/realtime/step_recorder.hpp>
#include <haptics/realtime/watchdog.hpp>

#include <doctest/doctest.h>
#include <time.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <mutex>
#include <span>
#include <string>

#include "support/realtime_guard.hpp"

using haptics::StepTime;
using haptics::testing::RealtimeGuard;
using haptics::testing::Violation;

namespace {

struct Snapshot {
    std::int64_t stamp_ns{0};
    std::array<double, 1000> values{};
};

// a step that uses all there is for steps
class GuardedStep : public haptics::LoopStep {
  public:
    void step(const StepTime& time) override {
        guard.begin({.clock_nanosleep = true});
        const auto reading = snapshots.try_read();
        const double factor = watchdog.step(haptics::age_s(time.clock_ns, reading.value.stamp_ns), time.dt);
        reports.slot().values[0] = factor;
        reports.publish();
        events.try_push(time.index);
        recorder.try_append(std::array{time.time(), factor});
        misbehave(time);
        steps.fetch_add(1);
    }
    void loop_ends() noexcept override { guard.end(); }
    virtual void misbehave(const StepTime& /*time*/) {}

    RealtimeGuard guard;
    std::atomic<int> steps{0};
    haptics::LatestValue<Snapshot> snapshots;
    haptics::LatestValue<Snapshot> reports;
    haptics::EventQueue<std::int64_t, 256> events;
    haptics::StepRecorder recorder{{"t_s", "factor"}, 512};
    haptics::Watchdog watchdog;
};

// the scene's side of it, until the loop has done so many steps
void run(GuardedStep& step, int steps) {
    haptics::LoopThread loop;
    REQUIRE(loop.start(step));
    while (step.steps < steps && loop.running()) {
        step.snapshots.slot().values.fill(step.steps);
        step.snapshots.publish();
        step.events.drain([](std::int64_t) {});
        step.recorder.drain([](std::span<const double>) {});
        static_cast<void>(step.reports.try_read());
        static_cast<void>(loop.statistics());
        const timespec brief{0, 5000000};
        nanosleep(&brief, nullptr);
    }
    loop.stop();
}

} // namespace

TEST_CASE("the loop, its exchange, its recorder and its counts neither allocate, lock nor block") {
    GuardedStep step;
    run(step, 1000);
    CHECK(std::string(step.guard.first()).empty());
    CHECK(step.guard.violations() == 0);
    // a thread gives up its processor only in the loop's own sleep, once a step; a few more are the kernel's
    // (a page that another thread is mapping). Sanitizers have locks of their own.
    if (RealtimeGuard::traps()) {
        CHECK(step.guard.context_switches() <= step.steps + 20);
    }
}

TEST_CASE("that proof fails when a step locks" * doctest::skip(!RealtimeGuard::traps())) {
    class Locking final : public GuardedStep {
        void misbehave(const StepTime& time) override {
            if (time.index == 50) {
                const std::lock_guard lock(mutex_);
            }
        }
        std::mutex mutex_;
    };
    Locking step;
    run(step, 100);
    CHECK(step.guard.count(Violation::lock) == 1);
    CHECK(std::string(step.guard.first()) == "pthread_mutex_lock");
}

TEST_CASE("that proof fails when a step allocates or sleeps" * doctest::skip(!RealtimeGuard::traps())) {
    class Allocating final : public GuardedStep {
        void misbehave(const StepTime& time) override {
            if (time.index == 50) {
                delete[] kept_;
                kept_ = new double[100];
            }
            if (time.index == 60) {
                const timespec brief{0, 1000};
                nanosleep(&brief, nullptr);
            }
        }
        double* kept_{new double[100]};

      public:
        ~Allocating() override { delete[] kept_; }
    };
    Allocating step;
    run(step, 100);
    CHECK(step.guard.count(Violation::allocation) == 1);
    CHECK(step.guard.count(Violation::deallocation) == 1);
    CHECK(step.guard.count(Violation::sleep) == 1);
    CHECK(step.guard.violations() == 3);
}
