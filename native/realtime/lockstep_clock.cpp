// Step k (from 0) stands for the interval [k P, (k+1) P) and is due once the scene has reached its end:
// steps due = floor(scene / P) - steps taken.
#include <haptics/realtime/lockstep_clock.hpp>

#include <algorithm>
#include <cmath>

namespace haptics {

LockstepClock::LockstepClock(double rate_hz) noexcept
    : period_ns_(period_ns(is_valid_lockstep_rate(rate_hz) ? rate_hz : k_default_rate_hz)) {}

int LockstepClock::begin_tick(double duration_s) noexcept {
    const double duration = duration_s > 0.0 ? std::min(duration_s, k_longest_tick_s) : 0.0;
    // to the nearest: sixty times the double next to 1/60 s is a hair less or more than one second, and has
    // to be one
    const double exact = duration * 1e9 + fraction_ns_;
    const double whole = std::nearbyint(exact);
    fraction_ns_ = exact - whole;
    scene_ns_ += static_cast<std::int64_t>(whole);
    return static_cast<int>(scene_ns_ / period_ns_ - steps_);
}

StepTime LockstepClock::next() noexcept {
    const std::int64_t time = steps_ * period_ns_;
    const double dt = static_cast<double>(period_ns_) * 1e-9;
    return {.index = steps_++, .time_ns = time, .clock_ns = time, .dt = dt, .skipped = 0};
}

void LockstepClock::reset() noexcept {
    scene_ns_ = 0;
    fraction_ns_ = 0.0;
    steps_ = 0;
}

} // namespace haptics
