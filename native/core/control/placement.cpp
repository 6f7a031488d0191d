// Fade. The share is s(u) = 3 u^2 - 2 u^3, whose slope is at most 1.5, with u growing by h/T in a step. A
// force F changes by at most 1.5 F h / T then, which is k_largest_step for T = 1.5 F h / k_largest_step.
//
// Turn. x'' = w^2 (wanted - x) - 2 w x' = 2 w (w/2 (wanted - x) - x') comes to rest without passing its end.
// Limits on the rate wanted inside of the bracket and on x'' keep both bounded; slowing down from the largest
// rate takes w/2 times that rate, which has to be less than the limit on x''.

#include <haptics/core/control/placement.hpp>

#include <algorithm>
#include <cmath>

namespace haptics {
namespace {

constexpr double k_turn_frequency = 10.0; // rad/s
constexpr double k_turn_rate = 10.0;      // rad/s
constexpr double k_turn_gain = 100.0;     // rad/s^2
constexpr double k_most_turn = 1e4;       // rad

bool same(const Mapping& a, const Mapping& b) {
    return a.scale == b.scale && a.rotation == b.rotation && a.offset == b.offset;
}

bool usable(const HandPlacement& p) {
    const Mapping& m = p.mapping;
    return m.scale >= 0.01 && m.scale <= 100.0 && std::abs(m.rotation) <= 10.0 && m.offset.allFinite() &&
           m.offset.cwiseAbs().maxCoeff() <= 100.0 && std::abs(p.turn) <= k_most_turn;
}

} // namespace

std::vector<FigureError> validate(const HandPlacement& p) {
    FigureCheck check;
    check.range("mapping_scale", p.mapping.scale, 0.01, 100.0, "m/m",
                "1 shows the device's motion at its true size.");
    check.range("mapping_rotation", p.mapping.rotation, -10.0, 10.0, "rad", "0 is the default.");
    for (int i = 0; i < 3; ++i)
        check.range("mapping_offset", p.mapping.offset(i), -100.0, 100.0, "m",
                    "Keep the workspace near the world node.");
    check.range("turn", p.turn, -k_most_turn, k_most_turn, "rad", "0 leaves the angle to the handle.");
    return check.take();
}

void Turn::advance(double wanted, double step) {
    const double due = std::clamp(0.5 * k_turn_frequency * (wanted - angle_), -k_turn_rate, k_turn_rate);
    // implicitly: holds at every step
    const double change =
        step * 2.0 * k_turn_frequency / (1.0 + step * 2.0 * k_turn_frequency) * (due - rate_);
    rate_ += std::clamp(change, -step * k_turn_gain, step * k_turn_gain);
    angle_ += step * rate_;
}

void Fade::advance(bool in, double force, double step) {
    const double lasts = std::clamp(1.5 * force * step / k_largest_step, k_shortest, k_longest);
    time_ = std::clamp(time_ + (in ? step : -step) / lasts, 0.0, 1.0);
}

Placement::Placement(const HandPlacement& start)
    : wanted_(start)
    , mapping_(start.mapping)
    , turn_(start.turn) {
    if (start.clutched)
        fade_.set(0.0);
}

void Placement::want(const HandPlacement& wanted) {
    if (usable(wanted))
        wanted_ = wanted;
}

bool Placement::interrupted() const {
    return wanted_.clutched || !same(wanted_.mapping, mapping_);
}

void Placement::advance(double force, double step) {
    turn_.advance(wanted_.turn, step);
    fade_.advance(!interrupted(), force, step);
}

} // namespace haptics
