#pragma once
/// Rows of numbers, one a haptic step, from the loop to the main thread.

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace haptics {

/// A ring of rows set aside at construction; single producer (the loop), single consumer (the main thread).
/// In real time the main thread drains it every frame and what does not fit is dropped and counted; in
/// lock-step both are one thread, which drains after every tick and loses nothing.
class StepRecorder {
  public:
    /// `columns`: names with their unit (`force_x_n`), at least one. `rows`: capacity, rounded up to a power
    /// of two; four seconds of the loop is plenty. Allocates everything that it will ever need.
    StepRecorder(std::vector<std::string> columns, std::size_t rows);
    StepRecorder(const StepRecorder&) = delete;
    StepRecorder& operator=(const StepRecorder&) = delete;

    /// Loop thread: the row to fill whole, columns().size() numbers; empty when the ring is full (the row is
    /// counted as dropped). Nothing is kept without commit(). Wait-free.
    [[nodiscard]] std::span<double> try_row() noexcept;
    /// Loop thread: keeps the row that the last try_row() gave. Wait-free.
    void commit() noexcept;
    /// Loop thread: try_row(), copy, commit(). False when dropped or when `values` is not as long as the
    /// columns.
    bool try_append(std::span<const double> values) noexcept;

    /// Main thread: hands the rows there are now to `take(std::span<const double>)`, oldest first, and
    /// returns how many. A row is valid only during its call.
    template <typename Take>
    std::size_t drain(Take&& take) {
        const std::uint64_t end = head_.load(std::memory_order_acquire);
        std::uint64_t tail = tail_.load(std::memory_order_relaxed);
        const std::size_t count = end - tail;
        while (tail != end) {
            take(std::span<const double>(row(tail)));
            tail_.store(++tail, std::memory_order_release);
        }
        return count;
    }

    /// Any thread: names of the columns; fixed.
    [[nodiscard]] const std::vector<std::string>& columns() const noexcept { return columns_; }
    /// Any thread: rows that fit.
    [[nodiscard]] std::size_t capacity() const noexcept { return mask_ + 1; }
    /// Any thread: rows ever kept.
    [[nodiscard]] std::uint64_t recorded() const noexcept { return head_.load(std::memory_order_relaxed); }
    /// Any thread: rows that did not fit.
    [[nodiscard]] std::uint64_t dropped() const noexcept { return dropped_.load(std::memory_order_relaxed); }

  private:
    static constexpr std::size_t k_line = 64;

    [[nodiscard]] std::span<double> row(std::uint64_t number) noexcept {
        return {&values_[(number & mask_) * columns_.size()], columns_.size()};
    }

    std::vector<std::string> columns_;
    std::size_t mask_;
    std::vector<double> values_;
    alignas(k_line) std::atomic<std::uint64_t> head_{0};
    std::atomic<std::uint64_t> dropped_{0};
    alignas(k_line) std::atomic<std::uint64_t> tail_{0};
};

} // namespace haptics
