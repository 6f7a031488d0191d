// Age. Host and device have clocks of their own. The difference d = host time of arrival - device time of a
// report is the offset of the clocks plus the way. The smallest d seen is the offset plus the shortest way; a
// report's age beyond that is d - min d, never negative. The minimum follows what lasts: it is let up by
// k_drift of the time that passes, which follows crystals (1e-4), and after every k_period reports by the
// least age among them, which follows a way that has become longer.

#include <haptics/devices/hid/hid_stream.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace haptics {

namespace {

constexpr double k_drift = 1.0e-3;
constexpr int k_period = 250;
// rounding and quiver
constexpr double k_slack_counts = 8.0;

std::int32_t ahead(std::uint32_t a, std::uint32_t b) {
    return static_cast<std::int32_t>(a - b);
}

} // namespace

void HidStream::begin(std::size_t axes, const std::array<double, k_hid_axes>& counts_per_radian,
                      bool absolute) {
    axes_ = std::min(axes, k_hid_axes);
    counts_per_radian_ = counts_per_radian;
    absolute_ = absolute;
    has_last_ = false;
    has_given_ = false;
    pending_ = false;
    lost_its_place_ = false;
    device_ns_ = 0;
    least_age_ns_ = std::numeric_limits<std::int64_t>::max();
    in_period_ = 0;
    interval_ = 0.0;
    age_ = 0.0;
}

void HidStream::take(std::span<const std::uint8_t> bytes, std::int64_t now_ns) {
    HidSample sample;
    switch (decode_input(bytes, sample)) {
    case HidDecode::good:
        break;
    case HidDecode::wrong_size:
        ++counts_.wrong_size;
        return;
    case HidDecode::wrong_version:
        ++counts_.wrong_version;
        return;
    case HidDecode::wrong_id:
    case HidDecode::wrong_crc:
    case HidDecode::out_of_range:
        ++counts_.corrupt;
        return;
    }
    if (has_last_) {
        const std::int32_t step = ahead(sample.sequence, last_.sequence);
        if (step == 0) {
            ++counts_.repeated;
            return;
        }
        const std::int32_t passed_us = ahead(sample.time_us, last_.time_us);
        if (step < 0 || passed_us < 0) {
            ++counts_.out_of_order;
            return;
        }
        counts_.lost += static_cast<std::uint64_t>(step - 1);
        const std::int64_t passed_ns = std::int64_t{passed_us} * 1000;
        device_ns_ += passed_ns;
        shortest_ns_ += std::llround(k_drift * static_cast<double>(passed_ns));
        shortest_ns_ = std::min(shortest_ns_, now_ns - device_ns_);
        least_age_ns_ = std::min(least_age_ns_, now_ns - device_ns_ - shortest_ns_);
        if (++in_period_ == k_period) {
            shortest_ns_ += least_age_ns_;
            least_age_ns_ = std::numeric_limits<std::int64_t>::max();
            in_period_ = 0;
        }
    } else {
        shortest_ns_ = now_ns - device_ns_;
    }
    counts_.superseded += pending_ ? 1U : 0U;
    has_last_ = true;
    last_ = sample;
    pending_ = true;
}

bool HidStream::jumps(const HidSample& sample, double seconds) const {
    for (std::size_t i = 0; i < axes_; ++i) {
        const double moved = std::abs(static_cast<double>(
            ahead(static_cast<std::uint32_t>(sample.count[i]), static_cast<std::uint32_t>(given_.count[i]))));
        if (moved > limits_.max_joint_speed * counts_per_radian_[i] * seconds + k_slack_counts)
            return true;
    }
    return false;
}

bool HidStream::newest(std::int64_t now_ns, HidSample& sample) {
    if (!pending_)
        return false;
    pending_ = false;
    const double age = static_cast<double>(now_ns - device_ns_ - shortest_ns_) * 1.0e-9;
    if (age > limits_.late) {
        ++counts_.late;
        return false;
    }
    const double passed = static_cast<double>(device_ns_ - given_ns_) * 1.0e-9;
    const bool first = !has_given_;
    const bool homed_anew = !first && last_.homings != given_.homings;
    const bool jumped = !first && !homed_anew && jumps(last_, passed);
    has_given_ = true;
    given_ = last_;
    given_ns_ = device_ns_;
    if (homed_anew)
        lost_its_place_ = false;
    if (jumped) {
        ++counts_.jumped;
        lost_its_place_ = true;
        quiet_ = 0;
        return false;
    }
    if (absolute_ && lost_its_place_ && ++quiet_ >= k_quiet)
        lost_its_place_ = false;
    ++counts_.accepted;
    interval_ = first ? 0.0 : passed;
    age_ = std::max(age, 0.0);
    sample = last_;
    return true;
}

} // namespace haptics
