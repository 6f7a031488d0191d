#pragma once
/// A bounded queue of events from one thread to another that never waits: what does not fit is dropped and
/// counted.

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <type_traits>

namespace haptics {

/// Single producer, single consumer ring of N events (N a power of two), oldest first. Every method is
/// wait-free and allocates nothing of its own; T's assignment must not throw. A full queue keeps what it has:
/// the newcomer is dropped, because a reader who sees the beginning of a burst can tell its cause.
template <typename T, std::size_t N>
class EventQueue {
    static_assert(N >= 2 && (N & (N - 1)) == 0, "the capacity of an EventQueue is a power of two");
    static_assert(std::is_default_constructible_v<T>);

  public:
    EventQueue() = default;
    EventQueue(const EventQueue&) = delete;
    EventQueue& operator=(const EventQueue&) = delete;

    /// Producer thread: false when the queue is full (the event is counted as dropped).
    bool try_push(const T& event) noexcept {
        const std::uint64_t head = head_.load(std::memory_order_relaxed);
        if (head - tail_.load(std::memory_order_acquire) == N) {
            dropped_.store(dropped_.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
            return false;
        }
        events_[head & (N - 1)] = event;
        head_.store(head + 1, std::memory_order_release);
        return true;
    }

    /// Consumer thread: false when the queue is empty; `event` is then left as it was.
    bool try_pop(T& event) noexcept {
        const std::uint64_t tail = tail_.load(std::memory_order_relaxed);
        if (head_.load(std::memory_order_acquire) == tail) {
            return false;
        }
        event = events_[tail & (N - 1)];
        tail_.store(tail + 1, std::memory_order_release);
        return true;
    }

    /// Consumer thread: hands what is there now to `take(const T&)`, oldest first, and returns how many.
    /// Events that come meanwhile wait for the next call, so it always ends.
    template <typename Take>
    std::size_t drain(Take&& take) {
        const std::uint64_t end = head_.load(std::memory_order_acquire);
        std::uint64_t tail = tail_.load(std::memory_order_relaxed);
        const std::size_t count = end - tail;
        while (tail != end) {
            const T event = events_[tail & (N - 1)];
            tail_.store(++tail, std::memory_order_release);
            take(event);
        }
        return count;
    }

    /// Any thread: events that did not fit.
    [[nodiscard]] std::uint64_t dropped() const noexcept { return dropped_.load(std::memory_order_relaxed); }
    /// Any thread: events ever accepted.
    [[nodiscard]] std::uint64_t pushed() const noexcept { return head_.load(std::memory_order_relaxed); }
    /// How many events fit.
    [[nodiscard]] static constexpr std::size_t capacity() noexcept { return N; }

  private:
    static constexpr std::size_t k_line = 64;

    std::array<T, N> events_{};
    alignas(k_line) std::atomic<std::uint64_t> head_{0};
    std::atomic<std::uint64_t> dropped_{0};
    alignas(k_line) std::atomic<std::uint64_t> tail_{0};
};

} // namespace haptics
