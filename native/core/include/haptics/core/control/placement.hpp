#pragma once
/// What the scene may change of the way the handle holds the tool while the loop runs: the clutch, the
/// mapping, and the angle that the scene adds to the handle's.

#include <haptics/core/control/mapping.hpp>
#include <haptics/core/figure_error.hpp>

#include <vector>

namespace haptics {

/// Wanted by the scene. Nothing of it jumps: see Placement.
struct HandPlacement {
    Mapping mapping;
    /// The tool stays where it is and the handle moves freely, to be put elsewhere in its workspace.
    bool clutched{false};
    /// Added to the handle's angle, rad, any number of turns. What turns the tool of a device with two
    /// freedoms.
    double turn{0.0};
};

/// Every figure out of range, with its remedy. Allocates; not for the haptic loop.
std::vector<FigureError> validate(const HandPlacement& placement);

/// An angle that follows a wanted one without a jump in its speed: critically damped, at most 10 rad/s.
class Turn {
  public:
    explicit Turn(double angle)
        : angle_(angle) {}
    void advance(double wanted, double step);
    [[nodiscard]] double angle() const { return angle_; } ///< rad
    [[nodiscard]] double rate() const { return rate_; }   ///< rad/s

  private:
    double angle_{0.0};
    double rate_{0.0};
};

/// A share that goes from 0 to 1 and back without a kink, and so slowly that a force times the share changes
/// by at most k_largest_step in a step: 0.1 s for small forces, at most 0.5 s.
class Fade {
  public:
    static constexpr double k_shortest = 0.1;      ///< s
    static constexpr double k_longest = 0.5;       ///< s
    static constexpr double k_largest_step = 0.04; ///< N

    explicit Fade(double share)
        : time_(share) {}
    /// `force` is what the share will be multiplied with, N.
    void advance(bool in, double force, double step);
    void set(double share) { time_ = share; }
    [[nodiscard]] double share() const { return time_ * time_ * (3.0 - 2.0 * time_); }

  private:
    double time_{0.0}; ///< 0..1
};

/// Clutch and change of mapping. The force fades out while the handle still leads the tool; then the tool is
/// parked; then the mapping changes or the handle moves; then the handle takes hold again where the tool is
/// parked, and the force fades in. Loop thread only.
class Placement {
  public:
    explicit Placement(const HandPlacement& start);

    /// Figures out of range are ignored.
    void want(const HandPlacement& wanted);
    /// One step; `force` is the size of the coupling's force, N.
    void advance(double force, double step);
    /// True when the force is gone and has to stay away: the tool is to be parked.
    [[nodiscard]] bool rests() const { return interrupted() && fade_.share() == 0.0; }
    /// Takes the wanted mapping into use. Only while it rests.
    void remap() { mapping_ = wanted_.mapping; }

    [[nodiscard]] const Mapping& mapping() const { return mapping_; }
    /// Part of the force that the hand has of the tool, 0..1.
    [[nodiscard]] double share() const { return fade_.share(); }
    [[nodiscard]] const Turn& turn() const { return turn_; }

  private:
    [[nodiscard]] bool interrupted() const;

    HandPlacement wanted_;
    Mapping mapping_;
    Fade fade_{1.0};
    Turn turn_;
};

} // namespace haptics
