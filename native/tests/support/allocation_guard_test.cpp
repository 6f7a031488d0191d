#include <doctest/doctest.h>

#include <cstdlib>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "support/allocation_guard.hpp"

using haptics::testing::AllocationGuard;

namespace {
// Keeps the compiler from leaving out a new/delete pair that it can see through.
void* volatile g_sink = nullptr;
} // namespace

TEST_CASE("the allocation guard counts nothing when nothing is allocated") {
    AllocationGuard guard;
    double sum = 0.0;
    for (int i = 0; i < 100; ++i) {
        sum += static_cast<double>(i);
    }
    CHECK(guard.allocations() == 0);
    CHECK(guard.deallocations() == 0);
    CHECK(sum == 4950.0);
}

TEST_CASE("the allocation guard counts new, delete and containers") {
    if (!AllocationGuard::counts_new()) {
        return;
    }
    AllocationGuard guard;
    {
        auto one = std::make_unique<int>(3);
        g_sink = one.get();
        std::vector<double> many(100, 1.0);
        g_sink = many.data();
        struct alignas(64) Wide {
            double values[8];
        };
        auto wide = std::make_unique<Wide>();
        g_sink = wide.get();
    }
    const auto allocations = guard.allocations();
    const auto deallocations = guard.deallocations();
    CHECK(allocations == 3);
    CHECK(deallocations == 3);
}

TEST_CASE("the allocation guard counts the malloc family") {
    if (!AllocationGuard::counts_malloc()) {
        return;
    }
    AllocationGuard guard;
    g_sink = std::malloc(8);
    std::free(g_sink);
    g_sink = std::calloc(2, 8);
    void* const smaller = g_sink;
    g_sink = std::realloc(smaller, 64);
    std::free(g_sink);
    g_sink = std::aligned_alloc(64, 64);
    std::free(g_sink);
    const auto allocations = guard.allocations();
    const auto deallocations = guard.deallocations();
    CHECK(allocations == 4);
    CHECK(deallocations == 3);
}

TEST_CASE("the allocation guard sees only its own thread") {
    if (!AllocationGuard::counts_new()) {
        return;
    }
    std::thread other;
    AllocationGuard outer;
    {
        // making a thread allocates here, what it allocates itself must not count here
        other = std::thread([] {
            for (int i = 0; i < 1000; ++i) {
                std::vector<int> many(100, i);
                g_sink = many.data();
            }
        });
    }
    other.join();
    const auto allocations = outer.allocations();
    CHECK(allocations > 0);
    CHECK(allocations < 100);
}
