#include <haptics/realtime/step_recorder.hpp>

#include <doctest/doctest.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <span>
#include <thread>
#include <vector>

#include "support/allocation_guard.hpp"

using haptics::StepRecorder;

TEST_CASE("rows come out as they went in") {
    StepRecorder recorder({"t_s", "x_m"}, 8);
    for (int i = 0; i < 5; ++i) {
        CHECK(recorder.try_append(std::array{0.001 * i, 1.0 * i}));
    }
    std::vector<double> values;
    CHECK(recorder.drain([&](std::span<const double> row) {
        values.insert(values.end(), row.begin(), row.end());
    }) == 5);
    CHECK(values == std::vector<double>{0.0, 0.0, 0.001, 1.0, 0.002, 2.0, 0.003, 3.0, 0.004, 4.0});
    CHECK(recorder.drain([](std::span<const double>) {}) == 0);
}

TEST_CASE("a full recorder keeps what it has and counts what it drops") {
    StepRecorder recorder({"n"}, 4);
    for (int i = 0; i < 7; ++i) {
        CHECK(recorder.try_append(std::array{1.0 * i}) == (i < 4));
    }
    CHECK(recorder.recorded() == 4);
    CHECK(recorder.dropped() == 3);
    double sum = 0.0;
    recorder.drain([&sum](std::span<const double> row) { sum += row[0]; });
    CHECK(sum == 6.0);
}

TEST_CASE("a row that is not committed is not kept, and a row of the wrong length is refused") {
    StepRecorder recorder({"a", "b", "c"}, 4);
    CHECK(recorder.try_row().size() == 3);
    CHECK_FALSE(recorder.try_append(std::array{1.0}));
    CHECK(recorder.recorded() == 0);
}

TEST_CASE("lock-step keeps everything when each tick is drained") {
    StepRecorder recorder({"n"}, 64);
    std::vector<double> kept;
    for (int tick = 0; tick < 1000; ++tick) {
        for (int i = 0; i < 17; ++i) {
            recorder.try_append(std::array{static_cast<double>(tick * 17 + i)});
        }
        recorder.drain([&kept](std::span<const double> row) { kept.push_back(row[0]); });
    }
    CHECK(recorder.dropped() == 0);
    REQUIRE(kept.size() == 17000);
    CHECK(kept.back() == 16999.0);
}

TEST_CASE("recording allocates nothing") {
    StepRecorder recorder({"a", "b"}, 16);
    haptics::testing::AllocationGuard guard;
    for (int i = 0; i < 100; ++i) {
        const auto row = recorder.try_row();
        if (!row.empty()) {
            row[0] = 1.0;
            row[1] = 2.0;
            recorder.commit();
        }
    }
    CHECK(guard.allocations() == 0);
    CHECK(recorder.dropped() == 84);
}

TEST_CASE("two threads: rows are whole and in order, and kept and dropped add up") {
    StepRecorder recorder({"a", "b", "c", "d"}, 128);
    constexpr int k_rows = 30000;
    std::atomic<bool> done{false};
    std::thread loop([&] {
        for (int i = 1; i <= k_rows; ++i) {
            const double v = i;
            recorder.try_append(std::array{v, v, v, v});
            if (i % 100 == 0) {
                std::this_thread::yield();
            }
        }
        done = true;
    });
    double last = 0.0;
    std::uint64_t rows = 0;
    bool good = true;
    const auto take = [&](std::span<const double> row) {
        good = good && row[0] > last && row[1] == row[0] && row[2] == row[0] && row[3] == row[0];
        last = row[0];
        ++rows;
    };
    while (!done) {
        recorder.drain(take);
        std::this_thread::yield();
    }
    loop.join();
    recorder.drain(take);
    CHECK(good);
    CHECK(rows + recorder.dropped() == k_rows);
}
