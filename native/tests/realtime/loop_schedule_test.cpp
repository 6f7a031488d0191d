#include <haptics/realtime/loop_schedule.hpp>

#include <doctest/doctest.h>

using haptics::LoopSchedule;
using haptics::StepTime;

TEST_CASE("a punctual loop keeps to its grid however the wakes jitter") {
    LoopSchedule schedule(1000, 100);
    for (int i = 0; i < 50; ++i) {
        REQUIRE(schedule.due_ns() == 1000 + 100 * i);
        const StepTime time = schedule.begin_step(schedule.due_ns() + i % 40);
        REQUIRE(time.index == i);
        REQUIRE(time.time_ns == 100 * i);
        REQUIRE(time.clock_ns == 1000 + 100 * i + i % 40);
        REQUIRE(time.skipped == 0);
        const auto outcome = schedule.end_step(time.clock_ns + 50);
        REQUIRE_FALSE(outcome.missed);
        REQUIRE(outcome.skipped == 0);
    }
}

TEST_CASE("a step of 2.5 periods misses its deadline once, costs two periods, and the next step is told") {
    LoopSchedule schedule(0, 100);
    static_cast<void>(schedule.begin_step(0));
    const auto outcome = schedule.end_step(250);
    CHECK(outcome.missed);
    CHECK(outcome.skipped == 2);
    CHECK(schedule.due_ns() == 300);
    const StepTime next = schedule.begin_step(300);
    CHECK(next.index == 1);
    CHECK(next.skipped == 2);
    CHECK(next.time_ns == 300);
    CHECK(next.dt == doctest::Approx(100e-9));
    CHECK_FALSE(schedule.end_step(350).missed);
    CHECK(schedule.begin_step(400).skipped == 0);
}

TEST_CASE("a wake 3.2 periods late runs one step, not a burst") {
    LoopSchedule schedule(0, 100);
    const StepTime time = schedule.begin_step(320);
    CHECK(time.skipped == 3);
    CHECK(time.time_ns == 300);
    const auto outcome = schedule.end_step(330);
    CHECK(outcome.missed);
    CHECK(outcome.skipped == 3);
    CHECK(schedule.due_ns() == 400);
}

TEST_CASE("a late wake and a late end add up") {
    LoopSchedule schedule(0, 100);
    CHECK(schedule.begin_step(120).skipped == 1);
    const auto outcome = schedule.end_step(310);
    CHECK(outcome.missed);
    CHECK(outcome.skipped == 3);
    CHECK(schedule.due_ns() == 400);
    CHECK(schedule.begin_step(400).skipped == 2);
}

TEST_CASE("a step that ends on the very next wake waits for the one after") {
    LoopSchedule schedule(0, 100);
    static_cast<void>(schedule.begin_step(0));
    const auto outcome = schedule.end_step(100);
    CHECK(outcome.missed);
    CHECK(outcome.skipped == 1);
    CHECK(schedule.due_ns() == 200);
}

TEST_CASE("steps and skipped periods always add up to the time gone by") {
    LoopSchedule schedule(0, 100);
    std::int64_t steps = 0;
    std::int64_t skipped = 0;
    std::int64_t told = 0;
    std::int64_t now = 0;
    unsigned random = 1;
    for (int i = 0; i < 10000; ++i) {
        random = random * 1664525u + 1013904223u;
        now = schedule.due_ns() + (random >> 8) % 350;
        const StepTime time = schedule.begin_step(now);
        told += time.skipped;
        REQUIRE(time.time_ns == 100 * (time.index + told));
        random = random * 1664525u + 1013904223u;
        now += (random >> 8) % 450;
        skipped += schedule.end_step(now).skipped;
        ++steps;
        REQUIRE(schedule.due_ns() > now);
        REQUIRE(schedule.due_ns() == 100 * (steps + skipped));
    }
}
