#include "support/allocation_guard.hpp"

#include "support/heap_hooks.hpp"
#include "support/sanitizers.hpp"

namespace haptics::testing {

AllocationGuard::AllocationGuard()
    : allocations_at_start_(heap_counters().allocations)
    , deallocations_at_start_(heap_counters().deallocations) {}

std::uint64_t AllocationGuard::allocations() const {
    return heap_counters().allocations - allocations_at_start_;
}

std::uint64_t AllocationGuard::deallocations() const {
    return heap_counters().deallocations - deallocations_at_start_;
}

bool AllocationGuard::counts_malloc() {
    return HAPTICS_TESTS_REPLACE_MALLOC;
}

bool AllocationGuard::counts_new() {
    return HAPTICS_TESTS_REPLACE_MALLOC || HAPTICS_TESTS_REPLACE_NEW;
}

} // namespace haptics::testing
