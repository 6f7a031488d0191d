#pragma once
/// The one way from a controller to a motor.

#include <haptics/core/pantograph/kinematics.hpp>
#include <haptics/core/safety/fault.hpp>
#include <haptics/core/safety/safety_limits.hpp>
#include <haptics/core/types.hpp>

#include <cstdint>
#include <optional>

namespace haptics {

/// What the gate did to a command. A bit field.
enum class GateFlag : std::uint32_t {
    none = 0,
    disarmed = 1U << 0U,          ///< not armed: no force
    faulted = 1U << 1U,           ///< a fault is latched: no force
    ramping = 1U << 2U,           ///< the start ramp is below 1
    paused = 1U << 3U,            ///< fading out, out, or coming back
    workspace_faded = 1U << 4U,   ///< near the edge of reach or the rotation stop
    singularity_faded = 1U << 5U, ///< near a singular pose
    speed_faded = 1U << 6U,       ///< near the speed limit, and the command adds power
    force_clamped = 1U << 7U,     ///< scaled to the force or torque limit
    slew_limited = 1U << 8U,      ///< a power-adding change was slowed
    motor_clamped = 1U << 9U,     ///< scaled to what the motors can give
};
/// Union of flags.
constexpr GateFlag operator|(GateFlag a, GateFlag b) {
    return static_cast<GateFlag>(static_cast<std::uint32_t>(a) | static_cast<std::uint32_t>(b));
}
/// True when `set` holds any bit of `bits`.
constexpr bool has(GateFlag set, GateFlag bits) {
    return (static_cast<std::uint32_t>(set) & static_cast<std::uint32_t>(bits)) != 0U;
}

/// Answer to an arming request; all but the first two name what to do.
enum class ArmResult : std::uint8_t {
    armed,                  ///< forces ramp up from now
    already_armed,          ///< nothing changed
    home_the_device_first,  ///< set_homed(true) was not called
    hold_the_handle_still,  ///< it moved within the last rest_time
    leave_contact,          ///< in contact, or the command is not small
    remove_the_cause_first, ///< the last inputs would fault again at once, or stop is pressed
};

/// What to do for the force to come, as a sentence; static storage. Empty once armed.
const char* describe_arming(ArmResult result);

/// Result of one step.
struct GateOutput {
    /// What goes to the device (N, N, N m): always finite, within every limit.
    Wrench applied{0.0, 0.0, 0.0};
    GateFlag flags{GateFlag::none};
    /// Start ramp times pause, 0..1; 0 when disarmed.
    double ramp{0.0};
    /// That times the fades near the edge of reach and near singular poses.
    double fade{0.0};
    /// Latched faults.
    Fault faults{Fault::none};
};

/// Checks, clamps and, when need be, shuts off every command. Nothing here allocates, locks or throws. Loop
/// thread only.
class OutputGate {
  public:
    /// Gate without knowledge of the linkage: no motor clamp, no workspace fade.
    explicit OutputGate(const SafetyLimits& limits);
    /// Gate of a pantograph: keeps a copy of its kinematics.
    OutputGate(const SafetyLimits& limits, const PantographKinematics& kinematics);

    /// One step: `command` (N, N, N m) at the handle `pose` (m, rad) with `twist` (m/s, rad/s), `dt` s since
    /// the last step. Call it in every step, armed or not: it also watches rest and free space.
    GateOutput apply(const Wrench& command, const Pose& pose, const Twist& twist, double dt);

    /// Arms, or re-arms after a fault (which clears it). `touching`: the tool is in contact. Refused unless
    /// homed, at rest and in free space.
    ArmResult arm(bool touching);
    /// No force from now on; not a fault.
    void disarm();
    /// The device knows its zero; false shuts the output.
    void set_homed(bool homed);
    /// Fades the output out (true) or back in (false); not a fault.
    void set_paused(bool paused) { paused_ = paused; }
    /// Most by which forces that faded at an edge or near a singular pose come back in the next step, 0..1. A
    /// force that grows under tension would give energy that nobody put in.
    void limit_return(double most) { most_return_ = most; }
    /// Latches faults found elsewhere (watchdogs, encoder residual, stop key).
    void raise(Fault fault);

    /// True when forces may pass.
    [[nodiscard]] bool armed() const { return armed_; }
    /// True when set_homed(true) was called last.
    [[nodiscard]] bool homed() const { return homed_; }
    /// Latched faults.
    [[nodiscard]] Fault faults() const { return faults_; }
    /// What went out last (N, N, N m).
    [[nodiscard]] const Wrench& applied() const { return applied_; }
    /// Net energy given to the hand within about energy_window, J.
    [[nodiscard]] double recent_energy() const { return energy_; }
    /// The linkage, where it is known.
    [[nodiscard]] const std::optional<PantographKinematics>& kinematics() const { return kinematics_; }
    /// The limits in force.
    [[nodiscard]] const SafetyLimits& limits() const { return limits_; }

  private:
    void shut();
    [[nodiscard]] Fault find_fault(const Wrench& command, const Pose& pose, const Twist& twist, double dt);
    void watch_rest(const Wrench& command, const Twist& twist, double dt);
    [[nodiscard]] double change_fraction(const Wrench& change, const Twist& twist, double dt) const;

    SafetyLimits limits_;
    std::optional<PantographKinematics> kinematics_;
    PantographState state_;
    WorkspaceReport workspace_;
    Wrench applied_{0.0, 0.0, 0.0};
    Pose last_pose_{0.0, 0.0, 0.0};
    bool has_last_pose_{false};
    Fault faults_{Fault::none};
    Fault present_{Fault::none};
    double ramp_{0.0};
    double open_{1.0};
    double place_fade_{1.0};
    double most_return_{1.0};
    double energy_{0.0};
    double too_fast_for_{0.0};
    double at_rest_for_{0.0};
    bool command_small_{false};
    bool armed_{false};
    bool homed_{false};
    bool paused_{false};
};

} // namespace haptics
