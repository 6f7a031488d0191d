// Readings x_j, taken t_j before the newest, carry an error of at most d each. The end-to-end line over n
// steps, slope v = (x_0 - x_n) / t_n, deviates from x_j by e_0 (1 - s) + e_n s - e_j with s = t_j / t_n when
// the true motion is straight: at most 2 d. So age n explains the samples between when |x_0 - v t_j - x_j| <=
// 2 d for all of them, that is when v lies in all intervals
//   (x_0 - x_j - 2 d) / t_j <= v <= (x_0 - x_j + 2 d) / t_j,  0 < j < n.
// The window is the largest n before the first that fails (the order of the original). Intervals only shrink,
// so one pass does. The slope is good to 2 d / t_n in straight motion, and lags half a window behind in
// curved motion.

#include <haptics/core/safety/velocity_estimator.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace haptics {

VelocityEstimator::VelocityEstimator(const Vec3& error, int window)
    : error_(error.cwiseMax(0.0))
    , window_(std::clamp(window, 1, k_capacity - 1)) {}

void VelocityEstimator::reset() {
    newest_ = -1;
    count_ = 0;
    velocity_.setZero();
    used_ = {0, 0, 0};
}

const VelocityEstimator::Sample& VelocityEstimator::back(int age) const {
    return ring_[static_cast<std::size_t>((newest_ - age + k_capacity) % k_capacity)];
}

Twist VelocityEstimator::update(const Pose& pose, double dt) {
    if (!pose.allFinite() || !std::isfinite(dt) || !(dt > 0.0))
        return velocity_;
    // times are kept relative to the newest sample's, which never loses digits however long the loop runs
    const double time = count_ > 0 ? std::fmod(back(0).time, 1.0e6) + dt : 0.0;
    newest_ = (newest_ + 1) % k_capacity;
    ring_[static_cast<std::size_t>(newest_)] = {pose, time};
    count_ = std::min(count_ + 1, k_capacity);

    const int oldest = std::min(window_, count_ - 1);
    for (int axis = 0; axis < 3; ++axis) {
        const double x = pose[axis];
        // a hair of slack: samples exactly on the bound are explained
        const double error = 2.0 * error_[axis] * (1.0 + 1.0e-9);
        double low = -std::numeric_limits<double>::infinity();
        double high = std::numeric_limits<double>::infinity();
        double slope = 0.0;
        int used = 0;
        for (int age = 1; age <= oldest; ++age) {
            const double elapsed = time - back(age).time;
            if (!(elapsed > 0.0))
                break;
            const double moved = x - back(age).pose[axis];
            const double candidate = moved / elapsed;
            if (candidate < low || candidate > high)
                break;
            slope = candidate;
            used = age;
            low = std::max(low, (moved - error) / elapsed);
            high = std::min(high, (moved + error) / elapsed);
        }
        velocity_[axis] = slope;
        used_[static_cast<std::size_t>(axis)] = used;
    }
    return velocity_;
}

} // namespace haptics
