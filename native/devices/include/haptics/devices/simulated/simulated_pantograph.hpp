#pragma once
/// A pantograph without hardware: handle, friction, encoders, delay, motors and the hand that holds it.

#include <haptics/core/control/device_port.hpp>
#include <haptics/core/figure_error.hpp>
#include <haptics/core/pantograph/kinematics.hpp>
#include <haptics/core/pantograph/presets.hpp>
#include <haptics/devices/simulated/delay_line.hpp>
#include <haptics/devices/simulated/simulated_hand.hpp>

#include <cstdint>
#include <random>
#include <vector>

namespace haptics {

/// How the handle pose is measured.
enum class EncoderModel {
    exact,  ///< no rounding
    handle, ///< x, y and theta rounded to encoder_resolution
    joint,  ///< joint angles rounded to encoder counts, pose by least squares over them
};

/// Where the handle's inertia comes from.
enum class InertiaModel {
    constant, ///< mass and inertia below, the same in every pose
    linkage,  ///< links, rotors and handle of the geometry, with their velocity terms and joint friction;
              ///< motors hold their torques between commands, as real ones do
};

/// Figures of a simulated pantograph.
struct SimulatedPantographOptions {
    /// Linkage; see its own `validate`.
    PantographGeometry geometry{ubc_twin_pantograph()};
    InertiaModel inertia_model{InertiaModel::constant};
    /// Effective mass, kg, 0.001 to 100, and inertia, kg m^2, 1e-7 to 10, of a constant handle.
    double mass{0.3};
    double inertia{3.0e-4};
    /// Viscous friction at the handle, N s/m, 0 to 1e3, and N m s/rad, 0 to 10 (on top of the geometry's
    /// joint friction in the linkage model).
    double viscous_friction{1.0};
    double rotation_viscous_friction{1.0e-3};
    /// Coulomb friction at the handle, N, 0 to 100, and N m, 0 to 10; sticks.
    double coulomb_friction{0.0};
    double rotation_coulomb_friction{0.0};
    /// Gravity in the device's plane, m/s^2, each within 50 (linkage model: on all parts; constant model: on
    /// the mass).
    Vec2 gravity{0.0, 0.0};
    EncoderModel encoder_model{EncoderModel::joint};
    /// Step of the handle model, m, m, rad, 0 (exact) to 0.1.
    Vec3 encoder_resolution{10.0e-6, 10.0e-6, 1.0e-4};
    /// Standard deviation of noise added before rounding, m, m, rad, 0 to 0.1 (handle and exact models), and
    /// its seed.
    Vec3 noise{0.0, 0.0, 0.0};
    std::uint64_t seed{1};
    /// Steps by which a written force acts late, 0 to 1000, on top of command_delay seconds, 0 to 1 (to half
    /// a sub-step).
    int command_delay_steps{0};
    double command_delay{0.0};
    /// Steps by which a reading is late, 0 to 1000.
    int reading_delay_steps{0};
    /// Motors hold to the geometry's torque limits; false gives whatever is commanded.
    bool limit_motors{true};
    /// The handle cannot leave the workspace; false lets it fly.
    bool bounded{true};
    /// Readings carry the force of the hand on the handle.
    bool measures_force{false};
    /// Readings carry the true velocity.
    bool measures_velocity{false};
    /// Longest sub-step of the simulation, s, 1e-6 to 1e-3.
    double sub_step{20.0e-6};
    SimulatedHandOptions hand{};
};

/// Every figure out of range, the geometry's and the hand's included. Empty when usable. Allocates; not for
/// the haptic loop.
std::vector<FigureError> validate(const SimulatedPantographOptions& options);

/// Simulated planar pantograph. Loop thread only. Deterministic: same options and calls, same bits. Allocates
/// in its constructor only.
class SimulatedPantograph final : public DevicePort {
  public:
    /// Throws std::invalid_argument with the first message of `validate` when the options are unusable.
    explicit SimulatedPantograph(const SimulatedPantographOptions& options);

    bool read(DeviceReading& reading) override;
    void write(const Wrench& force) override;
    void advance(double dt) override;
    [[nodiscard]] Mat3 handle_mass(const Pose& pose) const override;
    [[nodiscard]] int freedoms() const override { return kinematics_.freedoms(); }

    /// A new target for a target hand.
    void set_target(const HandTarget& target) { hand_.set_target(time_, target); }
    /// Buttons of the next readings.
    void set_buttons(std::uint32_t buttons) { buttons_ = buttons; }
    /// The hand, to change its grip or push between steps.
    SimulatedHand& hand() { return hand_; }
    [[nodiscard]] const SimulatedHand& hand() const { return hand_; }

    /// Puts the handle at `pose` (m, rad) with `twist`; for set-ups, not for use while a force is on. Ignored
    /// when outside the workspace.
    bool place(const Pose& pose, const Twist& twist = Twist::Zero());
    /// True pose, before encoders (m, rad).
    [[nodiscard]] const Pose& true_pose() const { return pose_; }
    /// True twist (m/s, rad/s).
    [[nodiscard]] const Twist& true_twist() const { return twist_; }
    /// Force between hand and handle at the end of the last advance (N, N, N m).
    [[nodiscard]] const Wrench& hand_force() const { return hand_force_; }
    /// Force of the motors at the end of the last advance, after delay and limits (N, N, N m).
    [[nodiscard]] const Wrench& motor_force() const { return motor_force_; }
    /// The force written last (N, N, N m), before delay; zero when it was not finite.
    [[nodiscard]] const Wrench& written() const { return written_; }
    /// Lets encoder `axis` slip by `counts` (joint encoders).
    void slip_encoder(int axis, double counts);
    /// Finds the encoders' zeros again: undoes every slip.
    void home() {
        slip_.setZero();
        ++homings_;
    }
    /// What the encoders disagree by in the last reading, rad (joint encoders of a twin; see PoseEstimate).
    [[nodiscard]] double encoder_residual() const { return residual_; }
    /// Simulated time since construction, s.
    [[nodiscard]] double time() const { return time_; }
    /// The device's kinematics, for the gate.
    [[nodiscard]] const PantographKinematics& kinematics() const { return kinematics_; }

  private:
    void sub_step(double h);
    void hold_inside(const Pose& before, const Mat3& mobility);
    void rub_joints(const PantographState& state, const Mat3& mobility, double h);
    [[nodiscard]] double room(const Pose& pose) const;
    struct Sample {
        Pose pose{0.0, 0.0, 0.0};
        JointVector angles{JointVector::Zero()};
    };
    /// What the motors were told: a wrench at the handle, and the joint torques for it.
    struct Command {
        Wrench wrench{0.0, 0.0, 0.0};
        JointVector torque{JointVector::Zero()};
    };
    [[nodiscard]] Sample exactly() const;
    [[nodiscard]] Sample measure();

    SimulatedPantographOptions options_;
    PantographKinematics kinematics_;
    SimulatedHand hand_;
    DelayLine<Command> command_steps_;
    TimedDelay<Command> command_time_;
    DelayLine<Sample> readings_;
    std::mt19937_64 random_;
    Pose pose_;
    Twist twist_{0.0, 0.0, 0.0};
    Pose measured_;
    JointVector slip_{JointVector::Zero()};
    /// Friction impulses of the joints in the last sub-step, N m s.
    JointVector rubbing_{JointVector::Zero()};
    Wrench written_{0.0, 0.0, 0.0};
    Wrench motor_force_{0.0, 0.0, 0.0};
    Wrench hand_force_{0.0, 0.0, 0.0};
    double time_{0.0};
    double residual_{0.0};
    std::uint64_t sequence_{0};
    std::uint32_t homings_{0};
    std::uint32_t buttons_{0};
};

} // namespace haptics
