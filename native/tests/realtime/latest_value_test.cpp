#include <haptics/realtime/latest_value.hpp>

#include <doctest/doctest.h>

#include <array>
#include <cstdint>
#include <thread>

#include "support/allocation_guard.hpp"

namespace {

// large enough that a torn copy would be seen
struct Wide {
    std::array<std::uint64_t, 512> words{};
};

} // namespace

TEST_CASE("a latest value starts with its initial value, which is not new") {
    haptics::LatestValue<int> exchange(7);
    const auto reading = exchange.try_read();
    CHECK(reading.value == 7);
    CHECK_FALSE(reading.is_new);
}

TEST_CASE("a latest value is new once, then stays") {
    haptics::LatestValue<int> exchange;
    CHECK(exchange.try_write(3));
    CHECK(exchange.try_read().is_new);
    const auto again = exchange.try_read();
    CHECK(again.value == 3);
    CHECK_FALSE(again.is_new);
    CHECK(exchange.value() == 3);
    CHECK(exchange.dropped() == 0);
}

TEST_CASE("a latest value hands on the newest and counts those overwritten") {
    haptics::LatestValue<int> exchange;
    for (int i = 1; i <= 5; ++i) {
        exchange.slot() = i;
        CHECK(exchange.publish() == (i == 1));
    }
    CHECK(exchange.try_read().value == 5);
    CHECK(exchange.dropped() == 4);
    CHECK(exchange.try_write(6));
    CHECK(exchange.try_read().value == 6);
}

TEST_CASE("the reader's value stays whole while the writer goes on") {
    haptics::LatestValue<int> exchange;
    exchange.try_write(1);
    const int& held = exchange.try_read().value;
    for (int i = 2; i < 50; ++i) {
        exchange.try_write(i);
        CHECK(held == 1);
    }
}

TEST_CASE("a latest value allocates nothing") {
    haptics::LatestValue<Wide> exchange;
    haptics::testing::AllocationGuard guard;
    exchange.slot().words[0] = 1;
    exchange.publish();
    const bool fresh = exchange.try_read().is_new;
    CHECK(guard.allocations() == 0);
    CHECK(fresh);
}

TEST_CASE("two threads: every value read is whole, none goes back, read and dropped add up") {
    haptics::LatestValue<Wide> exchange;
    constexpr std::uint64_t k_values = 20000;
    std::thread writer([&exchange] {
        for (std::uint64_t i = 1; i <= k_values; ++i) {
            exchange.slot().words.fill(i);
            exchange.publish();
            if (i % 64 == 0) {
                std::this_thread::yield();
            }
        }
    });
    std::uint64_t last = 0;
    std::uint64_t read = 0;
    bool whole = true;
    bool forward = true;
    while (last < k_values) {
        const auto reading = exchange.try_read();
        if (!reading.is_new) {
            std::this_thread::yield();
            continue;
        }
        ++read;
        const std::uint64_t first = reading.value.words.front();
        for (const std::uint64_t word : reading.value.words) {
            whole = whole && word == first;
        }
        forward = forward && first > last;
        last = first;
    }
    writer.join();
    CHECK(whole);
    CHECK(forward);
    CHECK(read + exchange.dropped() == k_values);
}
