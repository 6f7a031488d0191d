#pragma once
/// The hand that holds a simulated handle.

#include <haptics/core/figure_error.hpp>
#include <haptics/devices/simulated/recorded_path.hpp>
#include <haptics/devices/simulated/target_follower.hpp>

#include <vector>

namespace haptics {

/// What the hand does.
enum class HandKind {
    none,           ///< lets go
    constant_force, ///< pushes with a given wrench
    recorded_path,  ///< follows a table through its spring and damper
    target,         ///< follows targets (a mouse) through its spring and damper
};

/// Figures of a simulated hand. Its mass is carried by the handle whatever the kind.
struct SimulatedHandOptions {
    HandKind kind{HandKind::none};
    /// Mass, kg, 0 to 10, and inertia, kg m^2, 0 to 0.1, that move with the handle.
    double mass{0.0};
    double inertia{0.0};
    /// Stiffness of the grip, N/m, 0 to 1e5, and N m/rad, 0 to 1e3 (recorded_path and target).
    double stiffness{300.0};
    double rotation_stiffness{0.5};
    /// Damping over critical for hand and handle together, 0 to 10; 1 is critical.
    double damping_ratio{1.0};
    /// Largest force of the hand, N, 0 to 1e3, and torque, N m, 0 to 100 (recorded_path and target).
    double max_force{8.0};
    double max_torque{0.2};
    /// Wrench of a constant_force hand (N, N, N m; device frame), acting from start_time s on, each within
    /// 1e3.
    Wrench force{0.0, 0.0, 0.0};
    double start_time{0.0};
    /// Points of a recorded_path hand, times growing strictly.
    std::vector<HandTarget> path;
    PathInterpolation interpolation{PathInterpolation::smooth};
    bool repeat{false};
};

/// Mouse hand of the design: 0.15 kg, 300 N/m, critically damped, at most 8 N.
SimulatedHandOptions mouse_hand();
/// A hand with no mass that pushes with `force` (N, N, N m) from `start_time` s on.
SimulatedHandOptions pushing_hand(const Wrench& force, double start_time = 0.0);
/// A 0.15 kg hand that follows `path` with 1000 N/m.
SimulatedHandOptions path_hand(std::vector<HandTarget> path,
                               PathInterpolation interpolation = PathInterpolation::smooth,
                               bool repeat = false);

/// Every figure out of range. Empty when usable. Allocates; not for the haptic loop.
std::vector<FigureError> validate(const SimulatedHandOptions& options);

/// The hand. Loop thread only; allocates in its constructor only.
class SimulatedHand {
  public:
    /// `moved_mass`, `moved_inertia`: hand and handle together (kg, kg m^2), which damping_ratio refers to.
    /// `start`: handle pose at time 0.
    SimulatedHand(const SimulatedHandOptions& options, double moved_mass, double moved_inertia,
                  const Pose& start);

    /// The handle was put at `pose` at `time` s: a target hand rests there.
    void restart(double time, const Pose& pose);
    /// A new target (target hand), seen at the device's clock time `now` s.
    void set_target(double now, const HandTarget& target) { follower_.push(now, target); }
    /// A new constant wrench (N, N, N m). Non-finite is ignored.
    void set_force(const Wrench& force);
    /// Another grip: N/m and N s/m, both >= 0; non-finite or negative is ignored.
    void set_grip(double stiffness, double damping);
    /// Another grip in rotation: N m/rad and N m s/rad, both >= 0; non-finite or negative is ignored.
    void set_rotation_grip(double stiffness, double damping);

    /// Moves path and target on to `time` s; called once a sub-step before `force`.
    void advance(double time);
    /// Force of the hand's muscles at the given handle motion (N, N, N m).
    [[nodiscard]] Wrench force(const Pose& pose, const Twist& twist) const;
    /// Where the hand wants to be, for a ghost cursor; the handle's start pose for kinds that want nothing.
    [[nodiscard]] const Pose& wish() const { return wish_.pose; }
    /// The figures it was made from.
    [[nodiscard]] const SimulatedHandOptions& options() const { return options_; }
    /// Target play-back.
    [[nodiscard]] const TargetFollower& follower() const { return follower_; }

  private:
    SimulatedHandOptions options_;
    RecordedPath path_;
    TargetFollower follower_;
    PathSample wish_;
    bool pushing_{false};
    double stiffness_;
    double damping_;
    double rotation_stiffness_;
    double rotation_damping_;
};

} // namespace haptics
