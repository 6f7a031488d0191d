#pragma once
/// Turns targets that come at frame rate, unevenly, into a smooth motion at the rate of the simulation.

#include <haptics/devices/simulated/hand_target.hpp>

#include <array>

namespace haptics {

/// Plays targets back a little late (so that the next one is usually there), interpolates, and rounds off the
/// corners. Nothing allocates.
class TargetFollower {
  public:
    /// Targets kept for play-back.
    static constexpr int k_capacity = 32;

    /// Rests at `pose` from `time` s on.
    void reset(double time, const Pose& pose);
    /// A new target, seen at the clock time `now` s. Stale or non-finite ones are counted and dropped.
    void push(double now, const HandTarget& target);
    /// Moves on to the clock time `now` s (not before the last call).
    void advance(double now);

    /// The smooth target, m, rad.
    [[nodiscard]] const Pose& pose() const { return stage_[2]; }
    /// Its velocity, m/s, rad/s.
    [[nodiscard]] const Twist& velocity() const { return velocity_; }
    /// Play-back delay at present, s.
    [[nodiscard]] double delay() const { return delay_; }
    /// Targets dropped since reset.
    [[nodiscard]] long dropped() const { return dropped_; }

  private:
    [[nodiscard]] Pose interpolate(double time) const;
    [[nodiscard]] const HandTarget& at(int age) const;

    std::array<HandTarget, k_capacity> ring_{};
    int newest_{0};
    int count_{0};
    double now_{0.0};
    double delay_{0.034};
    double wanted_delay_{0.034};
    std::array<Pose, 3> stage_{Pose::Zero(), Pose::Zero(), Pose::Zero()};
    Twist velocity_{0.0, 0.0, 0.0};
    double time_constant_{0.02};
    long dropped_{0};
};

} // namespace haptics
