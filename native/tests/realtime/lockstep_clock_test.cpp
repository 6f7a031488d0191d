#include <haptics/realtime/lockstep_clock.hpp>

#include <doctest/doctest.h>

#include <cstdint>
#include <limits>
#include <vector>

using haptics::LockstepClock;
using haptics::StepTime;

TEST_CASE("an hour of ticks at awkward rates gives exactly the steps of an hour") {
    for (const int ticks_per_second : {24, 30, 59, 60, 75, 144, 240}) {
        LockstepClock clock(1000.0);
        std::int64_t steps = 0;
        for (int i = 0; i < 3600 * ticks_per_second; ++i) {
            steps += clock.advance(1.0 / ticks_per_second, [](const StepTime&) {});
            if ((i + 1) % ticks_per_second == 0) {
                REQUIRE(steps == std::int64_t{1000} * (i + 1) / ticks_per_second);
            }
        }
        CAPTURE(ticks_per_second);
        CHECK(steps == 3600000);
        CHECK(clock.scene_ns() == std::int64_t{3600} * 1000000000);
    }
}

TEST_CASE("step times are the grid, without gaps, whatever the ticks") {
    LockstepClock clock(2000.0);
    std::int64_t expected = 0;
    for (const double tick : {0.016, 0.0, 0.033, 0.0001, 0.0004, 0.5}) {
        clock.advance(tick, [&](const StepTime& time) {
            CHECK(time.index == expected);
            CHECK(time.time_ns == 500000 * expected);
            CHECK(time.clock_ns == time.time_ns);
            CHECK(time.dt == 0.0005);
            CHECK(time.skipped == 0);
            CHECK(time.time_ns + 500000 <= clock.scene_ns());
            ++expected;
        });
    }
    CHECK(expected == 2 * 549 + 1);
}

TEST_CASE("two clocks fed the same ticks give the same steps") {
    const auto run = [] {
        LockstepClock clock(1234.5);
        std::vector<std::int64_t> times;
        for (int i = 0; i < 1000; ++i) {
            clock.advance(0.001 * (i % 40),
                          [&times](const StepTime& time) { times.push_back(time.time_ns); });
        }
        return times;
    };
    CHECK(run() == run());
}

TEST_CASE("steps not taken stay due") {
    LockstepClock clock(1000.0);
    CHECK(clock.begin_tick(0.010) == 10);
    static_cast<void>(clock.next());
    CHECK(clock.begin_tick(0.005) == 14);
}

TEST_CASE("nonsense durations give no steps and a stall is cut") {
    LockstepClock clock(1000.0);
    CHECK(clock.begin_tick(-1.0) == 0);
    CHECK(clock.begin_tick(std::numeric_limits<double>::quiet_NaN()) == 0);
    CHECK(clock.begin_tick(std::numeric_limits<double>::infinity()) == 1000);
    clock.reset();
    CHECK(clock.scene_ns() == 0);
    CHECK(clock.next().index == 0);
}

TEST_CASE("lock-step goes on beyond the rates of a thread") {
    CHECK(LockstepClock(64000.0).next().dt == 15625e-9);
    CHECK(LockstepClock(100001.0).next().dt == 0.001);
}

TEST_CASE("a clock of an impossible rate takes the default") {
    CHECK(LockstepClock(0.0).next().dt == 0.001);
    CHECK(LockstepClock(std::numeric_limits<double>::quiet_NaN()).next().dt == 0.001);
}
