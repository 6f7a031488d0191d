// Handle observer.
//
// The handle is a mass M pushed by a known force u and by the hand's f, of which nothing is known but that it
// changes slowly: M v' = u + f, x' = v, f' = 0. Over a step T with both forces held,
//     x+ = x + T v + T^2/2 M^-1 (u + f),   v+ = v + T M^-1 (u + f),   f+ = f.
// A reading y of x corrects all three by the innovation e = y - x:
//     x += g e,   v += (h / T) e,   f += (k / T^2) M e.
// Gains of the critically damped filter, all three poles at p = exp(-w T) (for a diagonal M the axes part;
// the same holds for any M because M^-1 M k e = k e): g = 1 - p^3, h = 3/2 (1 - p)^2 (1 + p), k = (1 - p)^3;
// x and y share a p, the angle has its own. It is a disturbance observer: f takes up all that the model does
// not know, friction of the device included.
//
// Delay. Let tau be the time from the motion shown by a reading to the start of the force computed from it,
// tau = (d - 1 + s) T with 0 < s <= 1. Seen from the reading, the force sent d steps ago still acts for s T,
// then the one sent d - 1 ago, and so on. The state is kept at the time of the reading and moved on by tau
// with the forces that are on their way: a predictor without a model of the hand but "as now".

#include <haptics/core/control/handle_observer.hpp>

#include <algorithm>
#include <cmath>

namespace haptics {

HandleObserver::HandleObserver(double step, double delay, const Vec3& bandwidth)
    : step_(step) {
    const double steps = std::clamp(delay / step, 0.0, static_cast<double>(k_most_delay));
    // a millionth of a step is no delay
    delay_ = static_cast<int>(std::ceil(steps - 1e-6));
    part_ = delay_ > 0 ? steps - (delay_ - 1) : 1.0;
    for (int i = 0; i < 3; ++i) {
        const double p = std::exp(-std::max(bandwidth(i), 0.0) * step);
        gain_pose_(i) = 1.0 - p * p * p;
        gain_twist_(i) = 1.5 * (1.0 - p) * (1.0 - p) * (1.0 + p) / step;
        gain_force_(i) = (1.0 - p) * (1.0 - p) * (1.0 - p) / (step * step);
    }
    reset();
}

void HandleObserver::reset() {
    started_ = false;
    state_ = State{};
    hand_.setZero();
    ring_.fill(Wrench::Zero());
    newest_ = 0;
    twist_.setZero();
}

void HandleObserver::advance(State& state, const Wrench& force, double dt) const {
    const Vec3 acceleration = mobility_ * (force + hand_);
    state.pose += dt * state.twist + 0.5 * dt * dt * acceleration;
    state.twist += dt * acceleration;
}

const Wrench& HandleObserver::past(int age) const {
    const int size = static_cast<int>(ring_.size());
    return ring_[static_cast<std::size_t>((newest_ - age + size) % size)];
}

void HandleObserver::correct(const Pose& measured) {
    if (!measured.allFinite())
        return;
    if (!started_) {
        started_ = true;
        state_.pose = measured;
    } else {
        const Vec3 innovation = measured - state_.pose;
        state_.pose += gain_pose_.cwiseProduct(innovation);
        state_.twist += gain_twist_.cwiseProduct(innovation);
        hand_ += mass_ * gain_force_.cwiseProduct(innovation);
    }
    look_ahead();
}

void HandleObserver::sent(const Wrench& applied, const Mat3& mass) {
    newest_ = (newest_ + 1) % static_cast<int>(ring_.size());
    ring_[static_cast<std::size_t>(newest_)] = applied;
    mass_ = mass;
    mobility_ = mass.inverse();
    if (!started_)
        return;
    advance(state_, past(delay_), part_ * step_);
    if (part_ < 1.0)
        advance(state_, past(delay_ - 1), (1.0 - part_) * step_);
    look_ahead();
}

void HandleObserver::look_ahead() {
    State state = state_;
    if (delay_ > 0)
        advance(state, past(delay_ - 1), part_ * step_);
    for (int age = delay_ - 2; age >= 0; --age)
        advance(state, past(age), step_);
    pose_ = state.pose;
    twist_ = state.twist;
}

Pose HandleObserver::pose_ahead() const {
    State state{pose_, twist_};
    advance(state, Wrench::Zero(), step_);
    return state.pose;
}

Twist HandleObserver::twist_ahead() const {
    return twist_ + step_ * (mobility_ * hand_);
}

} // namespace haptics
