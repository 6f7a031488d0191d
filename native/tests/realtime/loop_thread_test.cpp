#include <haptics/realtime/loop_clock.hpp>
#include <haptics/realtime/loop_thread.hpp>

#include <doctest/doctest.h>
#include <sched.h>
#include <time.h>

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <iterator>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

using haptics::LoopOptions;
using haptics::LoopThread;
using haptics::StepTime;

namespace {

// calls what a test gives it
class TestStep final : public haptics::LoopStep {
  public:
    explicit TestStep(std::function<void(const StepTime&)> work = {})
        : work_(std::move(work)) {}

    void step(const StepTime& time) override {
        if (work_) {
            work_(time);
        }
        steps.fetch_add(1);
    }
    void loop_begins() noexcept override { begun.fetch_add(1); }
    void loop_ends() noexcept override { ended.fetch_add(1); }

    std::atomic<int> steps{0};
    std::atomic<int> begun{0};
    std::atomic<int> ended{0};

  private:
    std::function<void(const StepTime&)> work_;
};

void sleep_ms(long milliseconds) {
    const timespec time{milliseconds / 1000, milliseconds % 1000 * 1000000};
    nanosleep(&time, nullptr);
}

// no maximum on the wall clock: a machine that is slow enough only makes the test slow
template <typename Condition>
void wait_until(Condition condition) {
    while (!condition()) {
        sleep_ms(1);
    }
}

long thread_count() {
    return std::distance(std::filesystem::directory_iterator("/proc/self/task"),
                         std::filesystem::directory_iterator{});
}

// ordinary scheduling, so that the tests run the same everywhere
LoopOptions ordinary(double rate_hz = 1000.0) {
    LoopOptions options;
    options.rate_hz = rate_hz;
    options.priority = 0;
    options.lock_memory = false;
    options.hold_cpu_latency = false;
    return options;
}

} // namespace

TEST_CASE("a loop steps on the grid of its clock, and its counts agree") {
    for (const double rate : {250.0, 1000.0, 10000.0}) {
        std::vector<StepTime> times;
        times.reserve(200);
        TestStep step([&times](const StepTime& time) {
            if (times.size() < 200) {
                times.push_back(time);
            }
        });
        LoopThread loop;
        REQUIRE(loop.start(step, ordinary(rate)));
        CHECK(loop.running());
        wait_until([&step] { return step.steps >= 200; });
        loop.stop();
        CHECK_FALSE(loop.running());

        const std::int64_t period = loop.report().period_ns;
        std::int64_t skipped = 0;
        for (std::size_t i = 0; i < times.size(); ++i) {
            skipped += times[i].skipped;
            REQUIRE(times[i].index == static_cast<std::int64_t>(i));
            REQUIRE(times[i].time_ns == period * (times[i].index + skipped));
            REQUIRE(times[i].dt == static_cast<double>(period) * 1e-9);
            REQUIRE((i == 0 || times[i].clock_ns > times[i - 1].clock_ns));
        }
        const auto statistics = loop.statistics();
        CHECK(statistics.steps == static_cast<std::uint64_t>(step.steps));
        CHECK(statistics.wake_latency.count == statistics.steps);
        CHECK(statistics.step_time.count == statistics.steps);
        CHECK(statistics.skipped_periods >= static_cast<std::uint64_t>(skipped));
        CHECK(step.begun == 1);
        CHECK(step.ended == 1);
    }
}

TEST_CASE(
    "a step longer than its period is counted as missed and its periods are skipped, never made up for") {
    std::atomic<std::int64_t> told{0};
    TestStep step([&told](const StepTime& time) {
        told += time.skipped;
        const std::int64_t until = haptics::loop_clock_ns() + 2500000;
        while (haptics::loop_clock_ns() < until) {
        }
    });
    LoopThread loop;
    REQUIRE(loop.start(step, ordinary()));
    wait_until([&step] { return step.steps >= 20; });
    loop.stop();
    const auto statistics = loop.statistics();
    CHECK(statistics.missed_deadlines == statistics.steps);
    // each of 2.5 ms costs at least two periods of 1 ms
    CHECK(statistics.skipped_periods >= 2 * statistics.steps);
    CHECK(static_cast<std::uint64_t>(told) >= 2 * (statistics.steps - 1));
    CHECK(statistics.step_time.percentile(0.0) >= 2500000);
}

TEST_CASE("starting and stopping twice changes nothing") {
    TestStep step;
    LoopThread loop;
    loop.stop();
    CHECK_FALSE(loop.running());
    REQUIRE(loop.start(step, ordinary()));
    wait_until([&step] { return step.steps >= 3; });
    CHECK(loop.start(step, ordinary(250.0)));
    CHECK(loop.report().rate_hz == 1000.0);
    CHECK(step.begun == 1);
    loop.stop();
    loop.stop();
    CHECK(step.ended == 1);
    const int steps = step.steps;
    sleep_ms(5);
    CHECK(step.steps == steps);
}

TEST_CASE("200 starts and stops under load leave no thread behind") {
    std::atomic<bool> done{false};
    std::vector<std::thread> load;
    for (int i = 0; i < 3; ++i) {
        load.emplace_back([&done] {
            while (!done) {
            }
        });
    }
    sleep_ms(5);
    const long before = thread_count();
    TestStep step;
    auto loop = std::make_unique<LoopThread>();
    for (int i = 0; i < 200; ++i) {
        LoopOptions options = ordinary(10000.0);
        // every other time as a game asks for it, whatever of it is granted here
        if (i % 2 == 1) {
            options = LoopOptions{};
            options.rate_hz = 10000.0;
        }
        REQUIRE(loop->start(step, options));
        if (i % 3 == 0) {
            const int steps = step.steps;
            wait_until([&] { return step.steps > steps; });
        }
        // stopped by the destructor every fourth time
        if (i % 4 == 0) {
            loop = std::make_unique<LoopThread>();
        } else {
            loop->stop();
        }
    }
    CHECK(step.begun == 200);
    CHECK(step.ended == 200);
    // the kernel takes a joined thread off the list a moment later
    for (int i = 0; i < 1000 && thread_count() > before; ++i) {
        sleep_ms(1);
    }
    CHECK(thread_count() == before);
    done = true;
    for (auto& thread : load) {
        thread.join();
    }
}

TEST_CASE("an exception ends the loop, is told, and goes no further") {
    TestStep step([](const StepTime& time) {
        if (time.index == 5) {
            throw std::runtime_error("the spring broke");
        }
    });
    LoopThread loop;
    REQUIRE(loop.start(step, ordinary()));
    wait_until([&loop] { return !loop.running(); });
    CHECK(loop.failure() == "the spring broke");
    CHECK(step.steps == 5);
    CHECK(step.ended == 1);
    loop.stop();
    CHECK(loop.failure() == "the spring broke");

    TestStep odd([](const StepTime&) { throw 3; });
    REQUIRE(loop.start(odd, ordinary()));
    wait_until([&loop] { return !loop.running(); });
    CHECK(loop.failure() == "an exception that is no std::exception");

    // and a loop that failed can start again
    TestStep good;
    REQUIRE(loop.start(good, ordinary()));
    wait_until([&good] { return good.steps >= 3; });
    CHECK(loop.failure().empty());
    // a step outlives its loop
    loop.stop();
}

TEST_CASE("a step may stop its own loop without waiting for itself") {
    LoopThread loop;
    TestStep step([&loop](const StepTime& time) {
        if (time.index == 3) {
            loop.stop();
        }
    });
    REQUIRE(loop.start(step, ordinary()));
    wait_until([&loop] { return !loop.running(); });
    CHECK(step.steps == 4);
    loop.stop();
}

TEST_CASE("an impossible rate is refused with the fix") {
    TestStep step;
    LoopThread loop;
    CHECK_FALSE(loop.start(step, ordinary(5.0)));
    CHECK_FALSE(loop.running());
    CHECK(loop.report().failure == "the haptic rate is 5 Hz; set it between 250 and 10000 Hz.");
    CHECK(loop.report().describe().find("did not start") != std::string::npos);
    CHECK(step.begun == 0);
}

TEST_CASE("the report tells the truth about the thread") {
    std::atomic<int> policy{-1};
    std::atomic<int> priority{-1};
    std::atomic<int> processors{0};
    TestStep step([&](const StepTime&) {
        sched_param parameters{};
        sched_getparam(0, &parameters);
        priority = parameters.sched_priority;
        cpu_set_t set;
        sched_getaffinity(0, sizeof set, &set);
        processors = CPU_COUNT(&set);
        policy = sched_getscheduler(0);
    });
    LoopOptions options;
    options.priority = 99;
    options.cpu = 0;
    LoopThread loop;
    REQUIRE(loop.start(step, options));
    wait_until([&policy] { return policy != -1; });
    const auto report = loop.report();
    CHECK(report.fifo.asked);
    CHECK(report.priority == haptics::k_max_priority);
    CHECK(report.fifo.granted == (policy == (SCHED_FIFO | SCHED_RESET_ON_FORK)));
    CHECK(report.fifo.granted == (report.fifo.error == 0));
    if (report.fifo.granted) {
        CHECK(priority == haptics::k_max_priority);
    }
    if (report.affinity.granted) {
        CHECK(processors == 1);
    }
    loop.stop();

    options.cpu = 100000;
    REQUIRE(loop.start(step, options));
    CHECK_FALSE(loop.report().affinity.granted);
    CHECK_FALSE(loop.report().complete());
    CHECK(loop.report().describe().find("processor 100000: refused") != std::string::npos);
}
