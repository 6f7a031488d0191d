#include <haptics/realtime/event_queue.hpp>

#include <doctest/doctest.h>

#include <cstdint>
#include <thread>
#include <vector>

#include "support/allocation_guard.hpp"

TEST_CASE("an event queue gives events back in order") {
    haptics::EventQueue<int, 8> queue;
    for (int i = 0; i < 5; ++i) {
        CHECK(queue.try_push(i));
    }
    int event = -1;
    for (int i = 0; i < 5; ++i) {
        CHECK(queue.try_pop(event));
        CHECK(event == i);
    }
    CHECK_FALSE(queue.try_pop(event));
    CHECK(event == 4);
}

TEST_CASE("a full event queue keeps the oldest and counts what it drops") {
    haptics::EventQueue<int, 4> queue;
    for (int i = 0; i < 10; ++i) {
        CHECK(queue.try_push(i) == (i < 4));
    }
    CHECK(queue.dropped() == 6);
    CHECK(queue.pushed() == 4);
    std::vector<int> events;
    CHECK(queue.drain([&events](int event) { events.push_back(event); }) == 4);
    CHECK(events == std::vector<int>{0, 1, 2, 3});
    CHECK(queue.try_push(11));
}

TEST_CASE("draining ends although the handler pushes again") {
    haptics::EventQueue<int, 4> queue;
    queue.try_push(1);
    int handled = 0;
    queue.drain([&](int event) {
        ++handled;
        queue.try_push(event + 1);
    });
    CHECK(handled == 1);
}

TEST_CASE("an event queue allocates nothing") {
    haptics::EventQueue<double, 16> queue;
    haptics::testing::AllocationGuard guard;
    double sum = 0.0;
    for (int i = 0; i < 100; ++i) {
        queue.try_push(1.0);
        queue.drain([&sum](double event) { sum += event; });
    }
    CHECK(guard.allocations() == 0);
    CHECK(sum == 100.0);
}

TEST_CASE("two threads: events arrive in order, and received and dropped add up") {
    haptics::EventQueue<std::uint64_t, 64> queue;
    constexpr std::uint64_t k_events = 50000;
    std::thread producer([&queue] {
        for (std::uint64_t i = 1; i <= k_events; ++i) {
            queue.try_push(i);
            if (i % 50 == 0) {
                std::this_thread::yield();
            }
        }
    });
    std::uint64_t last = 0;
    std::uint64_t received = 0;
    bool forward = true;
    const auto take = [&](std::uint64_t event) {
        forward = forward && event > last;
        last = event;
        ++received;
    };
    while (queue.pushed() + queue.dropped() < k_events) {
        queue.drain(take);
        std::this_thread::yield();
    }
    producer.join();
    queue.drain(take);
    CHECK(forward);
    CHECK(received + queue.dropped() == k_events);
    CHECK(received == queue.pushed());
}
