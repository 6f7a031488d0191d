// A line from the newest sample x_0 with slope v explains sample x_j, taken t_j earlier, when |x_0 - v t_j -
// x_j| <= error, that is
//   (x_0 - x_j - error) / t_j <= v <= (x_0 - x_j + error) / t_j.
// All samples up to age n - 1 leave an interval of slopes; the end-to-end slope of age n, (x_0 - x_n) / t_n,
// explains them when it lies in that interval. The window is the largest n before the first that fails (the
// order of the original); one pass, since intervals only shrink. Both ends carry up to `error`, so the slope
// is good to 2 error / t_n.

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
        const double error = error_[axis] * (1.0 + 1.0e-9);
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
