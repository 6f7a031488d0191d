#include <haptics/realtime/tick_clock.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

using namespace haptics;

TEST_CASE("bunched and jittered ticks get even times") {
    constexpr double k_tick = 1.0 / 60.0;
    TickClock clock;
    double last = 0.0;
    double worst = 0.0;
    for (int i = 0; i < 600; ++i) {
        // frames at 20 a second carry three ticks each, and come up to 4 ms late
        const double frame = std::floor(i / 3.0) * 3.0 * k_tick + 0.004 * ((i / 3) % 3) / 2.0;
        const double time = clock.tick(frame, k_tick, i / 3);
        if (i > 60)
            worst = std::max(worst, std::abs(time - last - k_tick));
        last = time;
    }
    CHECK(worst < 0.1 * k_tick);
}

TEST_CASE("a tick clock follows a slow scene and starts anew after a stall") {
    constexpr double k_tick = 1.0 / 60.0;
    TickClock clock;
    double now = 0.0;
    double time = 0.0;
    for (int i = 0; i < 600; ++i) {
        now += 1.01 * k_tick; // one percent slower than it says
        time = clock.tick(now, k_tick, i);
    }
    CHECK(std::abs(time - now) < 0.25 * k_tick);
    // nothing was caught up: the scene stood still, and the clock is right again at the third frame
    now += 2.0;
    for (int i = 0; i < 3; ++i) {
        time = clock.tick(now, k_tick, 1000 + i);
        now += k_tick;
    }
    CHECK(time == doctest::Approx(now - k_tick).epsilon(1e-12));
    clock.reset();
    CHECK(clock.tick(now + 0.3, k_tick, 2000) == now + 0.3);
}

TEST_CASE("a late frame brings the ticks that were due, and their times go on evenly to the present") {
    constexpr double k_tick = 1.0 / 60.0;
    for (const double block : {0.04, 0.05, 0.07, 0.1, 0.13, 0.2, 0.5, 3.0}) {
        CAPTURE(block);
        TickClock clock;
        double now = 0.0;
        double time = 0.0;
        for (int i = 0; i < 100; ++i) {
            now += k_tick;
            time = clock.tick(now, k_tick, i);
        }
        // an engine runs eight ticks at most
        now += block + k_tick;
        const int due = static_cast<int>((block + k_tick) / k_tick + 1e-9);
        const double lost = std::max(due - 8, 0) * k_tick;
        for (int i = 0; i < std::min(due, 8); ++i) {
            const double next = clock.tick(now + 2e-4 * i, k_tick, 1000);
            if (i > 0)
                CHECK(next - time == doctest::Approx(k_tick).epsilon(1e-9));
            else
                CHECK(next - time - lost == doctest::Approx(k_tick).epsilon(0.02 + (lost > 0.0 ? 1.0 : 0.0)));
            time = next;
        }
        CHECK(now - time > -0.1 * k_tick);
        CHECK(now - time < 1.1 * k_tick);
        // and after it
        for (int i = 0; i < 10; ++i) {
            now += k_tick;
            const double next = clock.tick(now, k_tick, 2000 + i);
            CHECK(std::abs(next - time - k_tick) < 0.06 * k_tick);
            time = next;
        }
    }
}

TEST_CASE("a tick that is held up leaves the times of those that follow") {
    constexpr double k_tick = 1.0 / 60.0;
    for (const double held : {0.01, 0.03, 0.05, 0.07, 0.1, 0.12})
        for (const double gap : {0.001, 0.012}) {
            CAPTURE(held);
            CAPTURE(gap);
            TickClock clock;
            double due = 0.0;
            double time = 0.0;
            const auto handle = [&](double now, int frame) {
                const double next = clock.tick(now, k_tick, frame);
                CHECK(std::abs(next - time - k_tick) < (time > 0.0 ? 0.06 * k_tick : 1.0));
                time = next;
            };
            for (int i = 0; i < 100; ++i) {
                due += k_tick;
                handle(due, i);
            }
            due += k_tick;
            const double now = due + held;
            handle(now, 100);
            // the next frame brings what was due meanwhile
            const double frame = now + gap;
            for (; due + k_tick <= frame; due += k_tick)
                handle(frame, 101);
            for (int i = 0; i < 10; ++i) {
                due += k_tick;
                handle(due, 102 + i);
            }
        }
}
