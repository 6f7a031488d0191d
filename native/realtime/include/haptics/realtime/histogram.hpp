#pragma once
/// Counts of durations in fixed log-linear buckets, written by a loop and read by another thread.
///
/// Durations of 0 to 127 ns have a bucket each. Above, every octave [2^k, 2^(k+1)) is cut into 64 equal
/// buckets, so a bucket is at most 1/64 of its lower edge wide. A percentile is given as the upper edge of
/// its bucket: it is never below the true sample and at most 1.6 % above it. 2^36 ns (69 s) and more share
/// the last bucket; the largest sample is kept exactly.

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

namespace haptics {

/// Where the buckets lie.
struct HistogramBuckets {
    /// Number of buckets.
    static constexpr std::size_t k_count = 128 + 29 * 64;
    /// Largest relative error of a percentile: reported / true - 1 lies in [0, k_resolution].
    static constexpr double k_resolution = 1.0 / 64.0;

    /// Bucket of a duration (ns; below 0 counts as 0).
    [[nodiscard]] static std::size_t index(std::int64_t duration_ns) noexcept;
    /// Largest duration (ns) that falls into the bucket.
    [[nodiscard]] static std::int64_t upper_edge(std::size_t index) noexcept;
};

/// A copy of a histogram at one moment. Plain data of one thread, about 16 kB.
struct HistogramSnapshot {
    /// Samples in each bucket.
    std::array<std::uint64_t, HistogramBuckets::k_count> counts{};
    /// Samples in all buckets.
    std::uint64_t count{0};
    /// Sum of all samples (ns).
    std::int64_t sum_ns{0};
    /// Largest sample (ns), exact; 0 when there is none.
    std::int64_t max_ns{0};

    /// The smallest recorded duration (ns) that at least `fraction` (0..1) of the samples do not exceed,
    /// rounded up by at most HistogramBuckets::k_resolution; 0 when there is no sample.
    [[nodiscard]] std::int64_t percentile(double fraction) const noexcept;
    /// Median (ns).
    [[nodiscard]] std::int64_t p50_ns() const noexcept { return percentile(0.5); }
    /// ns.
    [[nodiscard]] std::int64_t p99_ns() const noexcept { return percentile(0.99); }
    /// ns.
    [[nodiscard]] std::int64_t p999_ns() const noexcept { return percentile(0.999); }
    /// Mean (ns), exact; 0 when there is no sample.
    [[nodiscard]] double mean_ns() const noexcept;
    /// Only what was added since `earlier`, a snapshot of the same histogram. Its max_ns is then a bucket's
    /// upper edge.
    [[nodiscard]] HistogramSnapshot since(const HistogramSnapshot& earlier) const noexcept;
};

/// The live histogram: one thread adds, any thread takes snapshots. All methods are wait-free and allocate
/// nothing.
class Histogram {
  public:
    /// Writer thread: counts one duration (ns).
    void add(std::int64_t duration_ns) noexcept;
    /// Any thread, though too long (2000 loads) for a haptic step. While the writer runs, the newest few
    /// samples may be in `counts` and not yet in `max_ns` or the reverse; `count` is always the sum of
    /// `counts`.
    [[nodiscard]] HistogramSnapshot snapshot() const noexcept;
    /// Empties it. Only while no thread adds.
    void clear() noexcept;

  private:
    std::array<std::atomic<std::uint64_t>, HistogramBuckets::k_count> counts_{};
    std::atomic<std::int64_t> sum_ns_{0};
    std::atomic<std::int64_t> max_ns_{0};
};

} // namespace haptics
