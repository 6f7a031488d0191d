#pragma once
/// Takes a device's weight, part of its friction and part of its inertia off the hand, without ever giving
/// the hand more energy than the device itself turns into heat.

#include <haptics/core/figure_error.hpp>
#include <haptics/core/pantograph/kinematics.hpp>

#include <array>
#include <vector>

namespace haptics {

/// What is compensated; all zero is off.
struct CompensationSettings {
    /// Gravity in the device's plane, m/s^2, each within 50; zero for a device that lies flat. The weight of
    /// links and handle is held.
    Vec2 gravity{0.0, 0.0};
    /// Share of the joint friction (MotorFigures) that is compensated, 0 to 0.7.
    double friction_share{0.0};
    /// Largest share of the inertia that is compensated, 0 to 0.5; less is given while the energy for it is
    /// not there.
    double inertia_share{0.0};
    /// Length of the velocity estimate, s, 0.001 to 0.05.
    double velocity_window{0.008};
    /// Joint rate at which Coulomb friction is compensated in full, rad/s, 0.001 to 10; less below it.
    double coulomb_rate{0.1};
    /// Corner of the filter of the acceleration, Hz, 1 to 100.
    double acceleration_bandwidth{20.0};
    /// Most energy that inertia compensation may save up from friction and lend again, J, 0 to 0.1.
    double energy_reserve{0.005};
    /// Time by which a force acts late and a reading is old, together, s, 0 to 0.05.
    double delay{0.0};
    /// Holds to the energy that friction has paid for. False is for tests of what happens without.
    bool budgeted{true};

    /// True when there is anything to do.
    [[nodiscard]] bool active() const {
        return !gravity.isZero(0.0) || friction_share > 0.0 || inertia_share > 0.0;
    }
};

/// Largest relative error of the masses and friction figures for which the compensation is passive.
inline constexpr double k_model_error = 0.3;

/// Every setting out of range, and what the geometry's figures do not allow. Allocates; not for the haptic
/// loop.
std::vector<FigureError> validate(const CompensationSettings& settings, const PantographGeometry& geometry);

/// Gravity, friction and inertia compensation of one device. Loop thread only; nothing allocates.
/// Derivation and proof of passivity in compensation.cpp.
class Compensation {
  public:
    /// `reading_error`: largest error of a reading (m, m, rad) of a device that does not give its joint
    /// angles.
    Compensation(const PantographKinematics& kinematics, const CompensationSettings& settings,
                 const Vec3& reading_error = Vec3::Zero());

    /// Begins anew: no velocity, no acceleration, no energy saved.
    void reset();
    /// A new reading, `dt` s after the last: handle pose (m, rad), and the joint angles (rad) where the
    /// device gives them, else null. Returns the wrench to add to the command (N, N, N m) until the next. A
    /// reading that is not finite, out of reach, or more than 0.1 s after the last gives zero and begins
    /// anew.
    Wrench update(const Pose& pose, const JointVector* angles, double dt);
    /// The share of the last wrench that reached the motors, 0 to 1, as the output gate says. Without a call
    /// it counts as 1.
    void passed(double share);

    /// Parts of the last wrench (N, N, N m).
    [[nodiscard]] const Wrench& gravity() const { return gravity_; }
    [[nodiscard]] const Wrench& friction() const { return friction_; }
    [[nodiscard]] const Wrench& inertia() const { return inertia_; }
    [[nodiscard]] const Wrench& repayment() const { return repayment_; }
    /// Share of the inertia compensation that the energy at hand allowed in the last step, 0 to 1.
    [[nodiscard]] double inertia_allowed() const { return allowed_; }
    /// Energy at hand, J.
    [[nodiscard]] double reserve() const { return reserve_; }
    /// Joint rates as estimated, rad/s: never more than the true mean over the window.
    [[nodiscard]] const JointVector& joint_rates() const { return rates_; }

  private:
    static constexpr int k_window = 64;
    static constexpr int k_delay = 256;
    struct Sent {
        /// Torques of inertia and gravity compensation, N m, and the share of them that reached the motors.
        JointVector torque{JointVector::Zero()};
        double share{1.0};
    };
    void start(const PantographState& state, const JointVector& angles, const JointVector& error);
    void estimate_rates(const JointVector& angles, const JointVector& error, double dt);
    void estimate_acceleration(const Pose& pose, double dt);
    void book(const PantographState& state, const JointVector& error, double dt);
    /// Torques of least size, as a driver finds them, limits left to the gate.
    [[nodiscard]] JointVector resolve(const PantographState& state, const Wrench& wrench) const;
    struct Reading {
        JointVector angles{JointVector::Zero()};
        /// Time since the one before, s.
        double dt{0.0};
    };
    [[nodiscard]] const Sent& sent(int age) const;
    [[nodiscard]] const Reading& past(int age) const;

    PantographKinematics kinematics_;
    CompensationSettings settings_;
    Vec3 reading_error_;
    std::array<Reading, k_window> past_{};
    std::array<Sent, k_delay> sent_{};
    int newest_{0};
    int past_count_{0};
    /// Time that the rates are a mean of, s.
    double span_{0.0};
    int newest_sent_{0};
    JointVector rates_{JointVector::Zero()};
    /// Joint angles as surely moved: follows the readings with a play of one reading error.
    JointVector sure_angles_{JointVector::Zero()};
    Pose last_pose_{0.0, 0.0, 0.0};
    JointVector last_angles_{JointVector::Zero()};
    double last_potential_{0.0};
    Vec3 slow_{0.0, 0.0, 0.0};
    Vec3 slower_{0.0, 0.0, 0.0};
    Vec3 acceleration_{0.0, 0.0, 0.0};
    Twist twist_{0.0, 0.0, 0.0};
    Wrench gravity_{0.0, 0.0, 0.0};
    Wrench friction_{0.0, 0.0, 0.0};
    Wrench inertia_{0.0, 0.0, 0.0};
    Wrench repayment_{0.0, 0.0, 0.0};
    double reserve_{0.0};
    double allowed_{0.0};
    bool started_{false};
};

} // namespace haptics
