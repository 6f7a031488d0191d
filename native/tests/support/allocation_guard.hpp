#pragma once
/// Counts what the calling thread takes from and gives back to the heap, so that a test can show that a step
/// does neither.
///
///     haptics::testing::AllocationGuard guard;
///     step(model, data, input);
///     CHECK(guard.allocations() == 0);
///
/// The counters are per thread and always running; a guard remembers where they stood. Guards nest.

#include <cstdint>

namespace haptics::testing {

/// Heap traffic of the thread that made the guard, since the guard was made. Use it on that thread only.
class AllocationGuard {
  public:
    AllocationGuard();

    /// Calls of malloc, calloc, realloc, aligned_alloc and operator new since the guard was made.
    [[nodiscard]] std::uint64_t allocations() const;
    /// Calls of free and operator delete with something to free since the guard was made.
    [[nodiscard]] std::uint64_t deallocations() const;

    /// False under AddressSanitizer and ThreadSanitizer, which own malloc: there only operator new and delete
    /// are counted.
    [[nodiscard]] static bool counts_malloc();
    /// False only under clang's ThreadSanitizer, which owns operator new too: there every count stays 0.
    [[nodiscard]] static bool counts_new();

  private:
    std::uint64_t allocations_at_start_;
    std::uint64_t deallocations_at_start_;
};

} // namespace haptics::testing
