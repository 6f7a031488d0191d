#pragma once
/// What the replaced heap functions of the test program leave behind, per thread. Guards read it; tests use
/// the guards.

#include <cstdint>

namespace haptics::testing {

/// Running counts of one thread.
struct HeapCounters {
    /// Every request for memory.
    std::uint64_t allocations{0};
    /// Every block given back.
    std::uint64_t deallocations{0};
};

/// The calling thread's counters. Neither allocates nor locks.
[[nodiscard]] HeapCounters& heap_counters() noexcept;

/// Called with the function's name on each heap call of a thread, after counting; null means none. A plain
/// function pointer of the thread, so that a guard can watch one thread without touching the others.
using HeapListener = void (*)(const char* function) noexcept;

/// Sets the calling thread's listener and returns the one before.
HeapListener set_heap_listener(HeapListener listener) noexcept;

} // namespace haptics::testing
