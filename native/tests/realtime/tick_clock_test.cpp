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
        const double time = clock.tick(frame, k_tick);
        if (i > 60)
            worst = std::max(worst, std::abs(time - last - k_tick));
        last = time;
    }
    CHECK(worst < 0.1 * k_tick);
}

TEST_CASE("a tick clock follows a slow scene and starts anew after a stall") {
    TickClock clock;
    double now = 0.0;
    double time = 0.0;
    for (int i = 0; i < 600; ++i) {
        now += 1.01 / 60.0; // one percent slower than it says
        time = clock.tick(now, 1.0 / 60.0);
    }
    CHECK(std::abs(time - now) < 0.25 / 60.0);
    now += 2.0;
    CHECK(clock.tick(now, 1.0 / 60.0) == now);
}
