#include <haptics/realtime/watchdog.hpp>

#include <algorithm>

namespace haptics {

double age_s(std::int64_t clock_ns, std::int64_t stamp_ns) noexcept {
    return clock_ns > stamp_ns ? static_cast<double>(clock_ns - stamp_ns) * 1e-9 : 0.0;
}

double watchdog_target(const WatchdogTimes& times, double age_s) noexcept {
    if (age_s <= times.fade_begins) {
        return 1.0;
    }
    // written so that NaN ends here
    if (!(age_s < times.fade_ends)) {
        return 0.0;
    }
    return (times.fade_ends - age_s) / (times.fade_ends - times.fade_begins);
}

double Watchdog::step(double age_s, double dt) noexcept {
    const double target = watchdog_target(times_, age_s);
    const double climb = times_.comes_back > 0.0 ? dt / times_.comes_back : 1.0;
    level_ = std::min(target, level_ + climb);
    const bool expired = target <= 0.0;
    stalls_ += expired && !expired_ ? 1 : 0;
    expired_ = expired;
    return factor();
}

double Watchdog::factor() const noexcept {
    return level_ * level_ * (3.0 - 2.0 * level_);
}

} // namespace haptics
