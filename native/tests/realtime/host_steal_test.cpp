#include <haptics/realtime/host_steal.hpp>

#include <doctest/doctest.h>

TEST_CASE("steal is the eighth figure of the first line, the total leaves the guests out") {
    const auto times =
        haptics::parse_processor_times("cpu  10 20 30 40 50 60 70 80 5 6\ncpu0 1 2 3 4 5 6 7 8 0 0\n");
    CHECK(times.has_value());
    const auto read = times.value_or(haptics::ProcessorTimes{});
    CHECK(read.stolen == 80);
    CHECK(read.total == 360);
}

TEST_CASE("text that is no processor line gives nothing") {
    CHECK_FALSE(haptics::parse_processor_times("").has_value());
    CHECK_FALSE(haptics::parse_processor_times("cpu0 1 2 3 4 5 6 7 8").has_value());
    CHECK_FALSE(haptics::parse_processor_times("cpu  1 2 3").has_value());
    CHECK_FALSE(haptics::parse_processor_times("cpu  1 2 3 x 5 6 7 8").has_value());
}

TEST_CASE("this machine's steal is a share") {
    haptics::HostSteal steal;
    if (!steal.begin()) {
        return;
    }
    const double fraction = steal.fraction().value_or(-1.0);
    CHECK(fraction >= 0.0);
    CHECK(fraction <= 1.0);
}
