#pragma once
/// The newest value of a large kind, handed from one thread to another without waiting.
///
/// Three slots: one belongs to the writer, one to the reader, one lies between them. Publishing and taking
/// each swap the own slot with the one between in a single atomic exchange, so neither side ever waits,
/// retries or sees a half-written value.

#include <array>
#include <atomic>
#include <cstdint>
#include <type_traits>

namespace haptics {

/// Single writer, single reader exchange of the newest T. Every method is wait-free and allocates nothing of
/// its own; T has to be pointer-free with fixed-size members, so that filling a slot allocates nothing
/// either.
template <typename T>
class LatestValue {
    static_assert(std::is_nothrow_destructible_v<T>);

  public:
    /// What the reader gets.
    struct Reading {
        /// The newest complete value; valid until the reader's next try_read().
        const T& value;
        /// True when no earlier try_read() returned this value.
        bool is_new;
    };

    /// All slots hold `initial`, which the reader sees, as not new, until the first publish().
    explicit LatestValue(const T& initial = T{})
        : slots_{Slot{initial}, Slot{initial}, Slot{initial}} {}
    LatestValue(const LatestValue&) = delete;
    LatestValue& operator=(const LatestValue&) = delete;

    /// Writer thread: the slot to fill. It holds an older value (of two or more publishes ago, or the initial
    /// one), so fill it whole. Valid until publish().
    [[nodiscard]] T& slot() noexcept { return slots_[writer_index_].value; }

    /// Writer thread: makes the filled slot the newest value. False when the value before it was never read
    /// (it is counted as dropped).
    bool publish() noexcept {
        const std::uint8_t before =
            between_.exchange(static_cast<std::uint8_t>(writer_index_ | k_fresh), std::memory_order_acq_rel);
        writer_index_ = before & k_index;
        const bool unread = (before & k_fresh) != 0;
        if (unread) {
            dropped_.store(dropped_.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
        }
        return !unread;
    }

    /// Writer thread: slot() = value; publish().
    bool try_write(const T& value) noexcept(std::is_nothrow_copy_assignable_v<T>) {
        slot() = value;
        return publish();
    }

    /// Reader thread: takes the newest value when there is a new one.
    [[nodiscard]] Reading try_read() noexcept {
        const bool fresh = (between_.load(std::memory_order_relaxed) & k_fresh) != 0;
        if (fresh) {
            // only the reader clears the mark, so it is still set in what the exchange returns
            const std::uint8_t before =
                between_.exchange(static_cast<std::uint8_t>(reader_index_), std::memory_order_acq_rel);
            reader_index_ = before & k_index;
        }
        return {slots_[reader_index_].value, fresh};
    }

    /// Reader thread: the value of the last try_read().
    [[nodiscard]] const T& value() const noexcept { return slots_[reader_index_].value; }

    /// Any thread: values overwritten before the reader took them.
    [[nodiscard]] std::uint64_t dropped() const noexcept { return dropped_.load(std::memory_order_relaxed); }

  private:
    static constexpr unsigned k_index = 3;
    static constexpr unsigned k_fresh = 4;
    static constexpr std::size_t k_line = 64;

    // a slot begins on its own cache line, so that the two threads do not slow each other
    struct alignas(k_line) Slot {
        T value;
    };

    std::array<Slot, 3> slots_;
    alignas(k_line) std::atomic<std::uint8_t> between_{1};
    std::atomic<std::uint64_t> dropped_{0};
    alignas(k_line) unsigned writer_index_{0};
    alignas(k_line) unsigned reader_index_{2};
};

} // namespace haptics
