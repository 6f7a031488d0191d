#pragma once
/// One haptic step from device to device: read, map, local model, control, output gate, write.

#include <haptics/core/control/coupling.hpp>
#include <haptics/core/control/device_care.hpp>
#include <haptics/core/control/device_port.hpp>
#include <haptics/core/control/handle_observer.hpp>
#include <haptics/core/control/impulse_channel.hpp>
#include <haptics/core/control/mapping.hpp>
#include <haptics/core/control/placement.hpp>
#include <haptics/core/control/report.hpp>
#include <haptics/core/control/shared_motion.hpp>
#include <haptics/core/local_model/free_linkage.hpp>
#include <haptics/core/local_model/local_model.hpp>
#include <haptics/core/safety/energy_ledger.hpp>
#include <haptics/core/safety/output_gate.hpp>
#include <haptics/core/safety/passivity_controller.hpp>
#include <haptics/core/safety/velocity_estimator.hpp>

#include <memory>
#include <optional>
#include <vector>

namespace haptics {

/// Estimates the handle's motion and the hand's force with a model of the device (handle_observer.hpp), and
/// chooses the coupling that goes with it (coupling_design.hpp).
struct ObserverSettings {
    bool enabled{false};
    /// From the motion that a reading shows to the start of the force computed from it, s, 0 to 63 steps.
    double delay{0.0};
    /// How fast the estimate follows in translation and in rotation, rad/s; 0 chooses it.
    double bandwidth{0.0};
    double rotation_bandwidth{0.0};
    /// Force noise that coarse encoders may cause (standard deviation), N, 0.001 to 10; torques k_arm of it.
    double noise{0.05};
    /// Largest relative error of the device's mass that the coupling has to bear, 0 to 0.5.
    double mass_error{0.25};
    /// Arm that turns noise of force into noise of torque, m.
    static constexpr double k_arm = 0.03;
};

struct SessionSettings {
    /// Period of the loop, s, 1e-4 to 4e-3; in lock-step down to 1e-5.
    double step{0.001};
    Coupling coupling{Coupling::four_channel};
    HandForce hand_force{HandForce::combined};
    /// Most of the device's inertia that `transparent` hides from the hand in free motion, 0 to 0.95. With an
    /// observer less is hidden where the computed loop does not bear it.
    double hidden_inertia{0.0};
    Mapping mapping;
    /// Coupling gains; all zero chooses default_gains.
    CouplingGains gains;
    ObserverSettings observer;
    /// Damps the handle while the loop has created energy. Hidden inertia always does.
    bool passivity_control{false};
    /// Delay that the device adds, s, >= 0; used to choose the gains without an observer.
    double device_delay{0.0};
    /// Period of the device's samples where it is longer than the loop's, s, >= 0; used likewise.
    double sample_period{0.0};
    /// Largest reading error per coordinate (half an encoder step), m, m, rad; used to estimate velocity.
    Vec3 reading_error{5e-6, 5e-6, 5e-5};
    /// The output faults when the device gave no new sample for so long, s, 0.002 to 1.
    double device_patience{0.02};
    /// Longest window of the velocity estimate, samples, 1 to 63: a longer one is quieter and lags more. 0
    /// chooses it by `observer.noise` together with the gains, and 2 where the gains are given.
    int velocity_window{0};
    /// Encoder check, and compensation of the device's own weight, friction and inertia (off by default).
    DeviceCareSettings care;
    /// Arm by itself as soon as the handle rests in free space. Faults still need a re-arm.
    bool arm_at_start{true};
    /// The tool is held from the start.
    bool hold_at_start{true};
};

/// Every setting out of range, with its remedy. Allocates; not for the haptic loop.
std::vector<FigureError> validate(const SessionSettings& settings);
/// The same, and what does not go together with the tool.
std::vector<FigureError> validate(const SessionSettings& settings, const Model& model);

/// Owns the local model's data and the controller's state; uses a device and a gate. Loop thread only, but
/// for the constructor.
class Session {
  public:
    /// Sets everything aside (allocates). `start` is the pose of a rigid tool's center of mass, or the
    /// coordinates of a linkage. `device` outlives the session.
    Session(const SessionSettings& settings, const Model& model, const OutputGate& gate, DevicePort& device,
            const LinkageVector& start);

    /// Takes a newer neighborhood.
    void take(const Neighborhood& neighborhood) { take_neighborhood(neighborhood, *data_); }
    /// The loop left out `seconds`: neighbors go on, the proxy waits.
    void skip(double seconds) { pass_time(*data_, seconds); }
    /// One step of the loop's period. Allocation-free, bounded, never throws.
    void step();

    /// The hand takes hold of the tool, gently where the tool moves, and the offset between handle and grip
    /// freezes; or lets go, in 0.1 s, and more slowly where a large force has to fade. The force starts at
    /// zero and changes by some 0.04 N in a step.
    void hold(bool held);
    /// What the scene wants of clutch, mapping and turn; takes effect without a jump of the force.
    void place(const HandPlacement& placement) { placement_.want(placement); }
    /// The hand takes hold elsewhere: at once when nothing is held, else after letting go. A link that the
    /// tool does not have is ignored.
    void grab(const Grip& grip);
    /// Coordinates of the tool go on at these rates (a start in motion); ignored unless there is one for each
    /// freedom.
    void set_rates(const LinkageVector& rates);
    /// Before the steps of all that meet in a loop: no wrench from before acts on this one, a linkage.
    void end_pushes();
    /// Before a step: the bodies that are links of `linkage`, number `id`, are where it has them. Both have
    /// the same step.
    void follow(Session& linkage, std::uint64_t id);
    /// After that step, before the linkage's own: hands it over what the tool gave to its links.
    void push(Session& linkage, std::uint64_t id);
    /// Asks the gate to arm, and to forget the faults latched now; the answer is in the next report's `armed`
    /// and in `arm_result()`.
    void arm();
    void disarm();
    /// Writes zero force to the device and disarms: the last thing before the loop ends.
    void shut_off();
    /// Latches a fault found elsewhere.
    void raise(Fault fault) { gate_.raise(fault); }
    /// Fades forces out or back in within 50 ms (pause, a scene that stalls).
    void set_paused(bool paused) { gate_.set_paused(paused); }

    [[nodiscard]] const HapticReport& report() const { return report_; }
    /// Events and details of the last step.
    [[nodiscard]] const StepOutput& output() const { return output_; }
    [[nodiscard]] const DeviceCare& care() const { return care_; }
    [[nodiscard]] ArmResult arm_result() const { return arm_result_; }
    [[nodiscard]] const SessionSettings& settings() const { return settings_; }
    [[nodiscard]] const Model& model() const { return *model_; }
    [[nodiscard]] const CouplingGains& gains() const { return gains_; }
    /// Part of the device's inertia that is hidden in free motion (`transparent`).
    [[nodiscard]] const HiddenInertia& hidden_inertia() const { return hidden_; }
    [[nodiscard]] const EnergyLedger& ledger() const { return ledger_; }
    [[nodiscard]] const PassivityController& passivity() const { return passivity_; }
    /// Null while none is enabled, and when no coupling holds with the device's figures: the loop then does
    /// without.
    [[nodiscard]] const HandleObserver* observer() const { return observer_ ? &*observer_ : nullptr; }
    /// Handle pose at which the grip would be at `grip` (device frame): where a pointing hand has to go.
    [[nodiscard]] Pose handle_for(const Pose& grip) const {
        return settings_.mapping.to_device(grip - grab_offset_ - turned());
    }
    [[nodiscard]] const Pose& grab_offset() const { return grab_offset_; }
    /// Coordinates of a linkage now, rad and m.
    [[nodiscard]] const LinkageVector& configuration() const { return data_->linkage.position; }

  private:
    void choose_gains();
    [[nodiscard]] bool observe(bool gains_chosen);
    [[nodiscard]] bool feeds_forward() const;
    [[nodiscard]] Mat3 loop_mobility() const;
    [[nodiscard]] double stored_energy() const;
    void grasp();
    void place_handle();
    void locate_handle();
    [[nodiscard]] Pose turned() const { return {0.0, 0.0, placement_.turn().angle()}; }
    [[nodiscard]] Pose target() const { return (parked_ ? park_ : Pose(handle_ + grab_offset_)) + turned(); }
    void place_target(HandInput& hand) const;
    void book_own_work();
    [[nodiscard]] double friction_work();
    void freeze_offset();
    void take_hold();
    void grow_firm();
    [[nodiscard]] double channels() const;
    [[nodiscard]] Wrench whole_hand_force() const;
    [[nodiscard]] double coupling_energy(double most_force, double most_torque) const;
    void read_device();
    void follow_handle();
    [[nodiscard]] Fault device_faults() const;
    void try_to_arm(Fault device);
    [[nodiscard]] bool is_transparent() const;
    void share(HandInput& hand);
    void run_model();
    [[nodiscard]] Wrench command();
    void report_linkage();
    void write_report(const GateOutput& gate, const Wrench& command);

    SessionSettings settings_;
    std::unique_ptr<Model> model_;
    std::unique_ptr<Data> data_;
    OutputGate gate_;
    DevicePort& device_;
    DeviceCare care_;
    VelocityEstimator velocity_;
    std::optional<HandleObserver> observer_;
    EnergyLedger ledger_;
    PassivityController passivity_;
    ImpulseChannel impulses_;
    CouplingGains gains_;
    DeviceReading reading_;
    StepOutput output_;
    HapticReport report_;
    ArmResult arm_result_{ArmResult::hold_the_handle_still};
    /// Handle in the scene, before the grab offset.
    Pose handle_{0.0, 0.0, 0.0};
    Twist handle_velocity_{0.0, 0.0, 0.0};
    Wrench hand_force_{0.0, 0.0, 0.0};
    Pose grab_offset_{0.0, 0.0, 0.0};
    Placement placement_;
    /// Where the tool is held while the handle is free (without turn).
    Pose park_{0.0, 0.0, 0.0};
    bool parked_{false};
    /// The coupling's gains were chosen here, so they follow a new scale.
    bool gains_follow_scale_{true};
    Pose last_target_{0.0, 0.0, 0.0};
    /// Work that sources, clutch and turn put in since the ledger was booked last, J.
    double source_work_{0.0};
    Mat3 device_mass_{Mat3::Identity()};
    Mat3 mobility_{Mat3::Zero()};
    /// What weighs a grip acceleration into a force (settings.hand_force).
    Mat3 felt_mass_{Mat3::Zero()};
    /// Grip to be taken once the present one has been let go.
    Grip next_grip_;
    bool regrab_{false};
    /// Acceleration feed-forward of the step (`transparent`).
    SharedMotion shared_;
    /// Most of the device's inertia that is hidden; how much of that is hidden now, 0..1.
    HiddenInertia hidden_;
    double hiding_{0.0};
    /// What the force channels lend in this step (ledger).
    LentMass lent_;
    /// Part of the last command that the gate let through.
    double share_{1.0};
    bool held_{false};
    /// How much of all forces passes between hand and tool: fades when the hand lets go.
    Fade grasp_{0.0};
    /// The same for the force channels alone: fades when the hand takes hold.
    Fade channels_{0.0};
    /// While the hand takes hold of a moving tool: part of the coupling's damping that acts, without a
    /// spring, and the time in which it grows by e, s. 1: it holds.
    double firmness_{1.0};
    double firming_time_{0.0};
    /// Steps until it is known how fast the tool moves past the hand.
    int taking_{0};
    /// Grip of the tool a step ago, and how fast it moved in the step.
    Pose last_grip_{0.0, 0.0, 0.0};
    Twist grip_velocity_{0.0, 0.0, 0.0};
    /// What the gate let through of the forces by ramp and pause, and by place too.
    double gate_ramp_{0.0};
    double gate_fade_{0.0};
    /// The last sample, for the work of a measured hand against the device's friction.
    Pose sampled_{0.0, 0.0, 0.0};
    Twist sampled_velocity_{0.0, 0.0, 0.0};
    Wrench sampled_hand_{0.0, 0.0, 0.0};
    /// Force of the hand fed to the tool in this step.
    Wrench fed_{0.0, 0.0, 0.0};
    bool fresh_{false};
    bool missing_{false};
    bool arm_wanted_{false};
    /// Of the last reading.
    std::uint32_t homings_{0};
    /// Faults that the last arm() was told to forget.
    Fault forgive_{Fault::none};
    /// Time since the last new sample as the loop counts it, and age of that sample, s.
    double silent_for_{0.0};
    double age_{0.0};
    /// Sum and number of the forces since the last new sample.
    Wrench force_sum_{0.0, 0.0, 0.0};
    double force_count_{0.0};
};

} // namespace haptics
