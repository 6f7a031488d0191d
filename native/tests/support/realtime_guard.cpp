#include "support/realtime_guard.hpp"

#include <sys/resource.h>

#include <cstring>

#include "support/heap_hooks.hpp"
#include "support/sanitizers.hpp"

namespace haptics::testing {

namespace {

constinit thread_local RealtimeGuard* t_guard = nullptr;
constinit thread_local int t_device_calls = 0;

void note_heap(const char* function) noexcept {
    const bool gives = std::strcmp(function, "free") == 0 || std::strcmp(function, "operator delete") == 0;
    RealtimeGuard::note_here(gives ? Violation::deallocation : Violation::allocation, function);
}

std::int64_t voluntary_switches() noexcept {
    rusage usage{};
    getrusage(RUSAGE_THREAD, &usage);
    return usage.ru_nvcsw;
}

} // namespace

void RealtimeGuard::begin(Allowed allowed) noexcept {
    if (t_guard == this) {
        return;
    }
    allowed_ = allowed;
    context_switches_ = -voluntary_switches();
    set_heap_listener(&note_heap);
    t_guard = this;
}

void RealtimeGuard::end() noexcept {
    if (t_guard != this) {
        return;
    }
    t_guard = nullptr;
    set_heap_listener(nullptr);
    context_switches_ += voluntary_switches();
}

std::uint64_t RealtimeGuard::violations() const noexcept {
    std::uint64_t sum = 0;
    for (const auto& count : counts_) {
        sum += count.load(std::memory_order_relaxed);
    }
    return sum;
}

std::uint64_t RealtimeGuard::count(Violation kind) const noexcept {
    return counts_[static_cast<std::size_t>(kind)].load(std::memory_order_relaxed);
}

const char* RealtimeGuard::first() const noexcept {
    return first_.load(std::memory_order_relaxed);
}

bool RealtimeGuard::traps() noexcept {
    return HAPTICS_TESTS_REPLACE_MALLOC;
}

RealtimeGuard::DeviceCall::DeviceCall() noexcept {
    ++t_device_calls;
}
RealtimeGuard::DeviceCall::~DeviceCall() {
    --t_device_calls;
}

void RealtimeGuard::note(Violation kind, const char* function) noexcept {
    if (violations() == 0) {
        first_.store(function, std::memory_order_relaxed);
    }
    counts_[static_cast<std::size_t>(kind)].fetch_add(1, std::memory_order_relaxed);
}

void RealtimeGuard::note_here(Violation kind, const char* function) noexcept {
    if (t_guard != nullptr && t_device_calls == 0) {
        t_guard->note(kind, function);
    }
}

void RealtimeGuard::note_clock_nanosleep() noexcept {
    if (t_guard != nullptr && !t_guard->allowed_.clock_nanosleep) {
        note_here(Violation::sleep, "clock_nanosleep");
    }
}

} // namespace haptics::testing
