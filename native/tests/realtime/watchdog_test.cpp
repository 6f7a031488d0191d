#include <haptics/realtime/watchdog.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>
#include <limits>

using haptics::Watchdog;
using haptics::WatchdogTimes;

namespace {
constexpr WatchdogTimes k_times{.fade_begins = 0.1, .fade_ends = 0.2, .comes_back = 0.3};
} // namespace

TEST_CASE("ages are taken on one clock, and news from the future are new") {
    CHECK(haptics::age_s(1500000000, 500000000) == 1.0);
    CHECK(haptics::age_s(500000000, 1500000000) == 0.0);
}

TEST_CASE("the age alone asks for 1, a straight line, 0") {
    CHECK(haptics::watchdog_target(k_times, 0.0) == 1.0);
    CHECK(haptics::watchdog_target(k_times, 0.1) == 1.0);
    CHECK(haptics::watchdog_target(k_times, 0.15) == doctest::Approx(0.5));
    CHECK(haptics::watchdog_target(k_times, 0.2) == 0.0);
    CHECK(haptics::watchdog_target(k_times, 100.0) == 0.0);
    CHECK(haptics::watchdog_target(k_times, std::numeric_limits<double>::quiet_NaN()) == 0.0);
    // no fade at all: a step from 1 to 0
    const WatchdogTimes sharp{.fade_begins = 0.1, .fade_ends = 0.1, .comes_back = 0.0};
    CHECK(haptics::watchdog_target(sharp, 0.1) == 1.0);
    CHECK(haptics::watchdog_target(sharp, 0.1001) == 0.0);
}

TEST_CASE("forces are gone when the fade ends and come back softly") {
    Watchdog watchdog(k_times);
    constexpr std::int64_t k_step = 1000000;
    std::int64_t now = 0;
    std::int64_t stamp = 0;
    double before = 0.0;
    double steepest_rise = 0.0;
    double steepest_fall = 0.0;
    int first_full = -1;
    int first_zero = -1;
    int full_again = -1;
    for (int i = 0; i < 2000; ++i, now += k_step) {
        // a scene at 60 Hz that stalls from 0.5 s to 1 s
        if (now < 500 * k_step || now >= 1000 * k_step) {
            stamp = now - now % (16 * k_step);
        }
        const double factor = watchdog.step(haptics::age_s(now, stamp), 0.001);
        REQUIRE(factor >= 0.0);
        REQUIRE(factor <= 1.0);
        steepest_rise = std::max(steepest_rise, factor - before);
        steepest_fall = std::max(steepest_fall, before - factor);
        before = factor;
        first_full = first_full < 0 && factor > 0.9999 ? i : first_full;
        first_zero = first_full > 0 && first_zero < 0 && factor == 0.0 ? i : first_zero;
        full_again = first_zero > 0 && full_again < 0 && factor > 0.9999 ? i : full_again;
    }
    // the last stamp before the stall is at 496 ms
    CHECK(first_full == doctest::Approx(300).epsilon(0.02));
    CHECK(first_zero == 696);
    CHECK(full_again == doctest::Approx(1300).epsilon(0.02));
    CHECK(watchdog.stalls() == 1);
    // steepest slope of l^2 (3 - 2 l) is 1.5
    CHECK(steepest_rise <= 1.5 * 0.001 / 0.3 + 1e-9);
    CHECK(steepest_fall <= 1.5 * 0.001 / 0.1 + 1e-9);
}

TEST_CASE("a watchdog starts at 0 and tells that news are too old") {
    Watchdog watchdog(k_times);
    CHECK(watchdog.factor() == 0.0);
    CHECK(watchdog.step(1.0, 0.001) == 0.0);
    CHECK(watchdog.expired());
    watchdog.step(0.0, 0.001);
    CHECK_FALSE(watchdog.expired());
}
