#include <haptics/realtime/histogram.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <memory>
#include <random>
#include <thread>
#include <vector>

#include "support/allocation_guard.hpp"

using haptics::Histogram;
using haptics::HistogramBuckets;

namespace {

// the independent truth: nearest rank in the sorted samples
std::int64_t sorted_percentile(std::vector<std::int64_t> samples, double fraction) {
    std::sort(samples.begin(), samples.end());
    const auto rank =
        static_cast<std::size_t>(std::ceil(fraction * static_cast<double>(samples.size()) - 1e-6));
    return samples[std::max<std::size_t>(rank, 1) - 1];
}

} // namespace

TEST_CASE("every bucket begins where the one before ends and is at most 1/64 wide") {
    for (std::size_t i = 0; i + 1 < HistogramBuckets::k_count; ++i) {
        const std::int64_t edge = HistogramBuckets::upper_edge(i);
        REQUIRE(HistogramBuckets::index(edge) == i);
        REQUIRE(HistogramBuckets::index(edge + 1) == i + 1);
        const auto lower = static_cast<double>(edge + 1);
        const auto upper = static_cast<double>(HistogramBuckets::upper_edge(i + 1));
        REQUIRE(upper <= lower * (1.0 + HistogramBuckets::k_resolution));
    }
    CHECK(HistogramBuckets::upper_edge(HistogramBuckets::k_count - 1) == (std::int64_t{1} << 36) - 1);
    CHECK(HistogramBuckets::k_resolution <= 0.03);
}

TEST_CASE("percentiles agree with the sorted samples within the stated resolution") {
    std::mt19937_64 random(42);
    std::lognormal_distribution<double> body(std::log(20e3), 1.5);
    for (const std::size_t size :
         {std::size_t{1}, std::size_t{2}, std::size_t{100}, std::size_t{1000}, std::size_t{50001}}) {
        auto histogram = std::make_unique<Histogram>();
        std::vector<std::int64_t> samples;
        for (std::size_t i = 0; i < size; ++i) {
            samples.push_back(static_cast<std::int64_t>(body(random)));
            histogram->add(samples.back());
        }
        const auto snapshot = histogram->snapshot();
        CHECK(snapshot.count == size);
        CHECK(snapshot.max_ns == *std::max_element(samples.begin(), samples.end()));
        for (const double fraction : {0.0, 0.01, 0.5, 0.9, 0.99, 0.999, 1.0}) {
            const auto truth = static_cast<double>(sorted_percentile(samples, fraction));
            const auto told = static_cast<double>(snapshot.percentile(fraction));
            CAPTURE(size);
            CAPTURE(fraction);
            CHECK(told >= truth);
            CHECK(told <= truth * (1.0 + HistogramBuckets::k_resolution));
        }
    }
}

TEST_CASE("an empty histogram gives zeros") {
    const Histogram histogram;
    CHECK(histogram.snapshot().p999_ns() == 0);
    CHECK(histogram.snapshot().mean_ns() == 0.0);
}

TEST_CASE("durations out of range land in the outer buckets and keep the exact maximum") {
    Histogram histogram;
    histogram.add(-5);
    histogram.add(std::int64_t{1} << 50);
    const auto snapshot = histogram.snapshot();
    CHECK(snapshot.counts.front() == 1);
    CHECK(snapshot.counts.back() == 1);
    CHECK(snapshot.max_ns == std::int64_t{1} << 50);
    CHECK(snapshot.percentile(1.0) == std::int64_t{1} << 50);
}

TEST_CASE("the difference of two snapshots holds only what came between") {
    Histogram histogram;
    histogram.add(1000000);
    const auto earlier = histogram.snapshot();
    for (int i = 0; i < 10; ++i) {
        histogram.add(100);
    }
    const auto window = histogram.snapshot().since(earlier);
    CHECK(window.count == 10);
    CHECK(window.max_ns == 100);
    CHECK(window.mean_ns() == 100.0);
    histogram.clear();
    CHECK(histogram.snapshot().count == 0);
}

TEST_CASE("adding and taking a snapshot allocate nothing") {
    Histogram histogram;
    haptics::testing::AllocationGuard guard;
    histogram.add(5000);
    const auto snapshot = histogram.snapshot();
    CHECK(guard.allocations() == 0);
    CHECK(snapshot.count == 1);
}

TEST_CASE("a snapshot taken while another thread adds never goes back") {
    Histogram histogram;
    constexpr std::uint64_t k_samples = 200000;
    std::atomic<bool> done{false};
    std::thread writer([&] {
        for (std::uint64_t i = 0; i < k_samples; ++i) {
            histogram.add(static_cast<std::int64_t>(i % 1000));
        }
        done = true;
    });
    std::uint64_t last = 0;
    bool forward = true;
    while (!done) {
        const auto snapshot = histogram.snapshot();
        forward = forward && snapshot.count >= last && snapshot.max_ns < 1000;
        last = snapshot.count;
    }
    writer.join();
    CHECK(forward);
    CHECK(histogram.snapshot().count == k_samples);
    CHECK(histogram.snapshot().max_ns == 999);
}
