// Replaces the heap functions of the test program. The definitions here win over the C library's, also for
// calls made inside shared libraries, and hand on to the C library's own entry points; dlsym is avoided
// because it may allocate. operator new of libstdc++ calls malloc, so it is replaced only where a sanitizer
// keeps malloc to itself.
#include "support/heap_hooks.hpp"

#include <cerrno>
#include <cstddef>
#include <cstdlib>
#include <new>

#include "support/sanitizers.hpp"

namespace haptics::testing {
namespace {

constinit thread_local HeapCounters t_counters{};
constinit thread_local HeapListener t_listener{nullptr};

[[maybe_unused]] void count_allocation(const char* function) noexcept {
    ++t_counters.allocations;
    if (t_listener != nullptr) {
        t_listener(function);
    }
}

[[maybe_unused]] void count_deallocation(const char* function) noexcept {
    ++t_counters.deallocations;
    if (t_listener != nullptr) {
        t_listener(function);
    }
}

} // namespace

HeapCounters& heap_counters() noexcept {
    return t_counters;
}

HeapListener set_heap_listener(HeapListener listener) noexcept {
    const HeapListener before = t_listener;
    t_listener = listener;
    return before;
}

} // namespace haptics::testing

using haptics::testing::count_allocation;
using haptics::testing::count_deallocation;

// NOLINTBEGIN(readability-inconsistent-declaration-parameter-name): the C library names them __like_this
#if HAPTICS_TESTS_REPLACE_MALLOC

extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* block, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);
void __libc_free(void* block);

#pragma GCC visibility push(default)
void* malloc(std::size_t size) noexcept {
    count_allocation("malloc");
    return __libc_malloc(size);
}

void* calloc(std::size_t count, std::size_t size) noexcept {
    count_allocation("calloc");
    return __libc_calloc(count, size);
}

void* realloc(void* block, std::size_t size) noexcept {
    count_allocation("realloc");
    return __libc_realloc(block, size);
}

void* memalign(std::size_t alignment, std::size_t size) noexcept {
    count_allocation("memalign");
    return __libc_memalign(alignment, size);
}

void* aligned_alloc(std::size_t alignment, std::size_t size) noexcept {
    count_allocation("aligned_alloc");
    return __libc_memalign(alignment, size);
}

int posix_memalign(void** block, std::size_t alignment, std::size_t size) noexcept {
    count_allocation("posix_memalign");
    *block = __libc_memalign(alignment, size);
    return *block == nullptr ? ENOMEM : 0;
}

void free(void* block) noexcept {
    if (block != nullptr) {
        count_deallocation("free");
        __libc_free(block);
    }
}
#pragma GCC visibility pop
}

#endif
// NOLINTEND(readability-inconsistent-declaration-parameter-name)

#if HAPTICS_TESTS_REPLACE_NEW

namespace {

void* take(std::size_t size, std::size_t alignment, bool may_throw) {
    count_allocation("operator new");
    const std::size_t wanted = size == 0 ? 1 : size;
    void* block = nullptr;
    if (alignment <= alignof(std::max_align_t)) {
        block = std::malloc(wanted);
    } else {
        block = std::aligned_alloc(alignment, (wanted + alignment - 1) / alignment * alignment);
    }
    if (block == nullptr && may_throw) {
        throw std::bad_alloc();
    }
    return block;
}

void give(void* block) noexcept {
    if (block != nullptr) {
        count_deallocation("operator delete");
        std::free(block);
    }
}

} // namespace

#pragma GCC visibility push(default)
void* operator new(std::size_t size) {
    return take(size, 0, true);
}
void* operator new[](std::size_t size) {
    return take(size, 0, true);
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
    return take(size, 0, false);
}
void* operator new[](std::size_t size, const std::nothrow_t&) noexcept {
    return take(size, 0, false);
}
void* operator new(std::size_t size, std::align_val_t at) {
    return take(size, static_cast<std::size_t>(at), true);
}
void* operator new[](std::size_t size, std::align_val_t at) {
    return take(size, static_cast<std::size_t>(at), true);
}
void operator delete(void* block) noexcept {
    give(block);
}
void operator delete[](void* block) noexcept {
    give(block);
}
void operator delete(void* block, std::size_t) noexcept {
    give(block);
}
void operator delete[](void* block, std::size_t) noexcept {
    give(block);
}
void operator delete(void* block, const std::nothrow_t&) noexcept {
    give(block);
}
void operator delete[](void* block, const std::nothrow_t&) noexcept {
    give(block);
}
void operator delete(void* block, std::align_val_t) noexcept {
    give(block);
}
void operator delete[](void* block, std::align_val_t) noexcept {
    give(block);
}
void operator delete(void* block, std::size_t, std::align_val_t) noexcept {
    give(block);
}
void operator delete[](void* block, std::size_t, std::align_val_t) noexcept {
    give(block);
}

#pragma GCC visibility pop

#endif
