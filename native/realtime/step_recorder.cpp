#include <haptics/realtime/step_recorder.hpp>

#include <algorithm>
#include <bit>
#include <utility>

namespace haptics {

StepRecorder::StepRecorder(std::vector<std::string> columns, std::size_t rows)
    : columns_(std::move(columns))
    , mask_(std::bit_ceil(std::max<std::size_t>(rows, 2)) - 1)
    // filled, so that the loop meets no page for the first time
    , values_((mask_ + 1) * columns_.size(), 0.0) {}

std::span<double> StepRecorder::try_row() noexcept {
    const std::uint64_t head = head_.load(std::memory_order_relaxed);
    if (columns_.empty() || head - tail_.load(std::memory_order_acquire) > mask_) {
        dropped_.store(dropped_.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
        return {};
    }
    return row(head);
}

void StepRecorder::commit() noexcept {
    head_.store(head_.load(std::memory_order_relaxed) + 1, std::memory_order_release);
}

bool StepRecorder::try_append(std::span<const double> values) noexcept {
    if (values.size() != columns_.size()) {
        return false;
    }
    const std::span<double> target = try_row();
    if (target.empty()) {
        return false;
    }
    std::copy(values.begin(), values.end(), target.begin());
    commit();
    return true;
}

} // namespace haptics
