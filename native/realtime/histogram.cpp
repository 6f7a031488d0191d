// Bucket of v >= 128 with its highest bit at k (k >= 7): octave k - 7, and within it the six bits below the
// highest,
//     index = 128 + 64 (k - 7) + ((v >> (k - 6)) - 64).
// The inverse: for index = 128 + 64 o + s the bucket is [(64 + s) 2^(o+1), (65 + s) 2^(o+1) - 1].
#include <haptics/realtime/histogram.hpp>

#include <algorithm>
#include <bit>
#include <cmath>

namespace haptics {

std::size_t HistogramBuckets::index(std::int64_t duration_ns) noexcept {
    if (duration_ns < 128) {
        return duration_ns < 0 ? 0 : static_cast<std::size_t>(duration_ns);
    }
    const auto value = static_cast<std::size_t>(duration_ns);
    const auto highest = static_cast<std::size_t>(63 - std::countl_zero(value));
    const std::size_t bucket = 128 + 64 * (highest - 7) + (value >> (highest - 6)) - 64;
    return std::min(bucket, k_count - 1);
}

std::int64_t HistogramBuckets::upper_edge(std::size_t index) noexcept {
    if (index < 128) {
        return static_cast<std::int64_t>(index);
    }
    const std::size_t octave = (index - 128) / 64;
    const std::size_t step = (index - 128) % 64;
    return (static_cast<std::int64_t>(65 + step) << (octave + 1)) - 1;
}

std::int64_t HistogramSnapshot::percentile(double fraction) const noexcept {
    if (count == 0) {
        return 0;
    }
    // nearest rank; the small subtraction keeps 0.99 x 100 from becoming rank 100 by rounding
    const double wanted =
        std::ceil(fraction * static_cast<double>(count) - 1e-9 * static_cast<double>(count));
    const auto rank = static_cast<std::uint64_t>(std::clamp(wanted, 1.0, static_cast<double>(count)));
    std::uint64_t seen = 0;
    for (std::size_t i = 0; i < counts.size(); ++i) {
        seen += counts[i];
        if (seen >= rank) {
            // the last bucket has no upper edge of its own
            return i + 1 == counts.size() ? max_ns : std::min(HistogramBuckets::upper_edge(i), max_ns);
        }
    }
    return max_ns;
}

double HistogramSnapshot::mean_ns() const noexcept {
    return count == 0 ? 0.0 : static_cast<double>(sum_ns) / static_cast<double>(count);
}

HistogramSnapshot HistogramSnapshot::since(const HistogramSnapshot& earlier) const noexcept {
    HistogramSnapshot difference;
    for (std::size_t i = 0; i < counts.size(); ++i) {
        difference.counts[i] = counts[i] - earlier.counts[i];
        difference.count += difference.counts[i];
        if (difference.counts[i] > 0) {
            difference.max_ns =
                i + 1 == counts.size() ? max_ns : std::min(HistogramBuckets::upper_edge(i), max_ns);
        }
    }
    difference.sum_ns = sum_ns - earlier.sum_ns;
    return difference;
}

void Histogram::add(std::int64_t duration_ns) noexcept {
    // one writer: load and store instead of a locked add
    auto& bucket = counts_[HistogramBuckets::index(duration_ns)];
    const std::int64_t counted = std::max<std::int64_t>(duration_ns, 0);
    if (counted > max_ns_.load(std::memory_order_relaxed)) {
        max_ns_.store(counted, std::memory_order_relaxed);
    }
    sum_ns_.store(sum_ns_.load(std::memory_order_relaxed) + counted, std::memory_order_relaxed);
    bucket.store(bucket.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
}

HistogramSnapshot Histogram::snapshot() const noexcept {
    HistogramSnapshot copy;
    for (std::size_t i = 0; i < counts_.size(); ++i) {
        copy.counts[i] = counts_[i].load(std::memory_order_relaxed);
        copy.count += copy.counts[i];
    }
    copy.sum_ns = sum_ns_.load(std::memory_order_relaxed);
    copy.max_ns = max_ns_.load(std::memory_order_relaxed);
    return copy;
}

void Histogram::clear() noexcept {
    for (auto& bucket : counts_) {
        bucket.store(0, std::memory_order_relaxed);
    }
    sum_ns_.store(0, std::memory_order_relaxed);
    max_ns_.store(0, std::memory_order_relaxed);
}

} // namespace haptics
