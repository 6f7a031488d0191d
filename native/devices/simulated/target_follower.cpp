// Targets carry the time at which they were taken. They are played back `delay` seconds late, straight from
// one to the next, and then pass three equal low-passes (time constant T each):  s1' = (u - s1)/T,  s2' = (s1
// - s2)/T,  s3' = (s2 - s3)/T. Straight pieces bend by a velocity step dv at every target; after three
// low-passes the acceleration is (dv/T)(t^2/2T^2)e^(-t/T): continuous, with a jerk of at most 0.23 dv/T^2.
// The hand's force follows mass times that, which is why it does not click.
//
// delay: the newest target must be older than the play-back time minus nothing, so the delay is the largest
// age that the newest target reached lately (a decaying maximum), approached at 10 % of real time: the
// play-back runs at 0.9 to 1.1 times real speed and never jumps. T is 0.6 of the delay between 8 and 30 ms:
// slow frames bend more and are rounded more.

#include <haptics/devices/simulated/target_follower.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace haptics {

namespace {

constexpr double k_first_delay = 0.034;
constexpr double k_least_delay = 0.004;
constexpr double k_largest_delay = 0.1;
constexpr double k_forget_time = 1.0;
constexpr double k_warp = 0.1;
constexpr double k_adapt_time = 0.3;
constexpr double k_margin = 1.1;
constexpr double k_least_constant = 0.016;
constexpr double k_largest_constant = 0.03;
constexpr double k_constant_per_delay = 0.9;

double constant_for(double delay) {
    return std::clamp(k_constant_per_delay * delay, k_least_constant, k_largest_constant);
}

} // namespace

void TargetFollower::reset(double time, const Pose& pose) {
    *this = TargetFollower{};
    now_ = time;
    delay_ = wanted_delay_ = k_first_delay;
    time_constant_ = constant_for(delay_);
    stage_ = {pose, pose, pose};
    ring_[0] = {time, pose};
    count_ = 1;
}

const HandTarget& TargetFollower::at(int age) const {
    return ring_[static_cast<std::size_t>((newest_ - age + k_capacity) % k_capacity)];
}

void TargetFollower::push(double now, const HandTarget& target) {
    if (!std::isfinite(target.time_s) || !target.pose.allFinite() || !std::isfinite(now)) {
        ++dropped_;
        return;
    }
    // a target cannot have been taken in the future
    HandTarget next{std::min(target.time_s, now), target.pose};
    const double since = next.time_s - at(0).time_s;
    if (count_ > 0 && since < 0.0) {
        ++dropped_;
        return;
    }
    // after a rest, the motion starts now and not where the rest began
    if (since > k_largest_delay) {
        const HandTarget rest{next.time_s - wanted_delay_, at(0).pose};
        newest_ = (newest_ + 1) % k_capacity;
        ring_[static_cast<std::size_t>(newest_)] = rest;
        count_ = std::min(count_ + 1, k_capacity);
    } else {
        wanted_delay_ =
            std::clamp(std::max(wanted_delay_, now - at(0).time_s), k_least_delay, k_largest_delay);
    }
    // two targets of one instant: the later one counts
    if (next.time_s - at(0).time_s > 1.0e-6 || count_ == 0) {
        newest_ = (newest_ + 1) % k_capacity;
        count_ = std::min(count_ + 1, k_capacity);
    }
    ring_[static_cast<std::size_t>(newest_)] = next;
}

Pose TargetFollower::interpolate(double time) const {
    if (time >= at(0).time_s)
        return at(0).pose;
    for (int age = 1; age < count_; ++age) {
        const HandTarget& older = at(age);
        if (time < older.time_s)
            continue;
        const HandTarget& newer = at(age - 1);
        const double share = (time - older.time_s) / (newer.time_s - older.time_s);
        return older.pose + share * (newer.pose - older.pose);
    }
    return at(count_ - 1).pose;
}

void TargetFollower::advance(double now) {
    const double step = now - now_;
    if (!(step > 0.0))
        return;
    now_ = now;
    wanted_delay_ = std::max(k_least_delay, wanted_delay_ * (1.0 - std::min(1.0, step / k_forget_time)));
    const double rate = (k_margin * wanted_delay_ - delay_) / k_adapt_time;
    delay_ += std::clamp(rate, -k_warp, k_warp) * step;
    // nothing to play: stand still, and go on from there when frames come again
    delay_ = std::max(delay_, std::min(now_ - at(0).time_s, k_largest_delay));
    time_constant_ += (constant_for(delay_) - time_constant_) * std::min(1.0, step / k_adapt_time);

    const double blend = 1.0 - std::exp(-step / time_constant_);
    const Pose input = interpolate(now_ - delay_);
    stage_[0] += blend * (input - stage_[0]);
    stage_[1] += blend * (stage_[0] - stage_[1]);
    stage_[2] += blend * (stage_[1] - stage_[2]);
    velocity_ = (stage_[1] - stage_[2]) / time_constant_;
}

} // namespace haptics
