// What is promised. Let the true device have joint friction of at least (1 - e) of its figures, e =
// k_model_error, and any masses. Then from the start to any time t the compensation gives the device at most
// what its gravity part has stored plus the heat of friction,
//   sum tau_k . (phi_{k+1} - phi_k)  <=  V(x_0) - V(x_t) + integral of true friction power,
// so that a hand gets nothing out of any closed path that it did not put in. A device holds joint torques
// from sample to sample, so all is reckoned at the joints: there the sums are exact. Each part on its own:
//
// Friction. With joint readings r_k = phi_k + error, |error| <= d, take the mean rate over n steps and pull
// it towards zero by what the errors can do:  w_k = dead zone( (r_k - r_{k-n}) / (n T), 2 d / (n T) ).  So
// |w_k| is at most the true mean rate of the window, and by Jensen's inequality
//   sum T w_k^2 <= sum_k T ( 1/(nT) integral over window k of phi' )^2 <= integral phi'^2      (each instant
//   is in n
// windows). Viscous part b w, held from step to step, b = share times figure:  integral b w phi' <= b |w|
// |phi'| (L2 norms) <= integral b phi'^2, whatever the delay, which only shifts w. Coulomb part: |torque| <=
// f = share times figure at all times, so integral torque phi' <= f integral |phi'|. Together at most share
// times the friction of the figures, and share <= 1 - e is at most the true friction. No tolerance is left
// over: rounding, rate and delay are in, as long as readings come evenly. (A twin's driver drops the part of
// the torques along the direction that no motion explains; its work is second order in a step.)
//
// Gravity. -V is the potential of the model's weight (inertia.hpp), so a wrong mass leaves a conservative
// force. Held for a step it lags T/2 and the delay, so the torques are those for where the handle will be by
// then. What that leaves, tau_g . dphi + dV, is booked below.
//
// Inertia. share (M a + c) with a from filtered positions. Any filter or delay makes part of it a negative
// damper (delayed acceleration is in phase with velocity), and a hand that stops at once keeps what it was
// lent; no fixed gain is passive without friction. So a ledger: energy in hand
//   R += (1 - e - share_f) * (heat by the figures)  -  tau_I . dphi  -  (tau_g . dphi + dV)  -  what rounding
//   may hide,
// and tau_I is cut so that it cannot run R below zero. The heat is booked from below: b T w^2 as above, and f
// |dp| with p following r by a play of half width d, whose path is never longer than the true one. Rounding:
// summed by parts, sum tau_k (e_{k+1} - e_k) = ends + sum (tau_{k-1} - tau_k) e_k, so |change of tau| d is
// charged. R is capped (energy_reserve): that much a path may get out that begins with a full ledger.
//
// The cut: with P the most that the power of tau_I can be now, P > 0, it is scaled to R / (P k_horizon),
// which lets R decay to zero and never jump; energy that it takes back (P < 0) is always taken. Where there
// is no friction to pay for what holding the weight leaks, R goes below zero: that debt is paid back by a
// light damping as the device moves on, so that it stays small instead of growing (without friction the
// promise holds but for that).

#include <haptics/core/pantograph/compensation.hpp>
#include <haptics/core/pantograph/inertia.hpp>
#include <haptics/core/pantograph/torque_map.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace haptics {

namespace {

// the energy at hand is spent no faster than in that time (s)
constexpr double k_horizon = 0.02;

// damping that pays a debt back takes at least 1 / that long to stop the device (1/s)
constexpr double k_repayment_rate = 20.0;

// after a longer gap between two readings all begins anew (s)
constexpr double k_longest_gap = 0.1;

double dead_zone(double value, double width) {
    return std::copysign(std::max(0.0, std::abs(value) - width), value);
}

} // namespace

std::vector<FigureError> validate(const CompensationSettings& settings, const PantographGeometry& geometry) {
    FigureCheck check("compensation.");
    for (int axis = 0; axis < 2; ++axis)
        check.range(
            axis == 0 ? "gravity.x" : "gravity.y", settings.gravity[axis], -50.0, 50.0, "m/s^2",
            "Use 0 for a device that lies flat, 9.81 along the axis that points down for one that stands.");
    check.range("friction_share", settings.friction_share, 0.0, 1.0 - k_model_error, "",
                "More is not passive when the true friction is less than its figures say.");
    check.range("inertia_share", settings.inertia_share, 0.0, 0.5, "",
                "More is not passive when the true mass is less than its figures say.");
    check.range("velocity_window", settings.velocity_window, 0.001, 0.05, "s", "0.008 is the default.");
    check.range("coulomb_rate", settings.coulomb_rate, 0.001, 10.0, "rad/s", "0.1 is the default.");
    check.range("acceleration_bandwidth", settings.acceleration_bandwidth, 1.0, 100.0, "Hz",
                "20 is the default.");
    check.range("energy_reserve", settings.energy_reserve, 0.0, 0.1, "J", "0.005 is the default.");
    check.range("delay", settings.delay, 0.0, 0.05, "s", "Most devices add less than 0.001 s.");
    // shares of nothing
    const bool frictionless =
        geometry.motor.viscous_friction == 0.0 && geometry.motor.coulomb_friction == 0.0;
    if (check.good() && frictionless && settings.friction_share > 0.0)
        check.inconsistent(
            "friction_share", settings.friction_share, 0.0, 0.0, "",
            "The geometry has no friction figures: measure its viscous_friction and coulomb_friction.");
    else if (check.good() && frictionless && settings.inertia_share > 0.0)
        check.inconsistent("inertia_share", settings.inertia_share, 0.0, 0.0, "",
                           "Friction pays for it, and the geometry has no friction figures: measure its "
                           "viscous_friction and coulomb_friction.");
    else if (check.good() && settings.inertia_share > 0.0 &&
             settings.friction_share > 1.0 - k_model_error - 0.05)
        check.inconsistent(
            "friction_share", settings.friction_share, 0.0, 1.0 - k_model_error - 0.05, "",
            "Leave some friction to pay for the inertia compensation, or set inertia_share to 0.");
    return check.take();
}

Compensation::Compensation(const PantographKinematics& kinematics, const CompensationSettings& settings,
                           const Vec3& reading_error)
    : kinematics_(kinematics)
    , settings_(settings)
    , reading_error_(reading_error.cwiseMax(0.0)) {}

void Compensation::reset() {
    started_ = false;
    past_count_ = 0;
    newest_ = 0;
    sent_.fill(Sent{});
    rates_.setZero();
    twist_.setZero();
    acceleration_.setZero();
    gravity_.setZero();
    friction_.setZero();
    inertia_.setZero();
    repayment_.setZero();
    reserve_ = 0.0;
    allowed_ = 0.0;
}

const Compensation::Sent& Compensation::sent(int age) const {
    return sent_[static_cast<std::size_t>((newest_sent_ - age + k_delay) % k_delay)];
}

void Compensation::passed(double share) {
    Sent& last = sent_[static_cast<std::size_t>(newest_sent_)];
    last.share = std::isfinite(share) ? std::clamp(share, 0.0, 1.0) : 0.0;
}

const Compensation::Reading& Compensation::past(int age) const {
    return past_[static_cast<std::size_t>((newest_ - age + k_window) % k_window)];
}

void Compensation::estimate_rates(const JointVector& angles, const JointVector& error, double dt) {
    // whole turns out
    Reading now{angles, dt};
    if (past_count_ > 0)
        for (int i = 0; i < k_max_motors; ++i)
            now.angles[i] =
                past(0).angles[i] + std::remainder(angles[i] - past(0).angles[i], 2.0 * std::numbers::pi);
    newest_ = (newest_ + 1) % k_window;
    past_[static_cast<std::size_t>(newest_)] = now;
    past_count_ = std::min(past_count_ + 1, k_window);
    // the mean over the window once there is a whole one, pulled towards zero
    rates_.setZero();
    span_ = 0.0;
    const double wanted = settings_.velocity_window - 0.5 * dt;
    for (int age = 0; age + 1 < past_count_; ++age) {
        span_ += past(age).dt;
        if (span_ < wanted && age + 2 < k_window)
            continue;
        for (int i = 0; i < kinematics_.motors(); ++i)
            rates_[i] = dead_zone((now.angles[i] - past(age + 1).angles[i]) / span_, 2.0 * error[i] / span_);
        return;
    }
    span_ = settings_.velocity_window;
}

void Compensation::estimate_acceleration(const Pose& pose, double dt) {
    // (1 - lag)^2 of the position is w^2-scaled acceleration behind a double pole; a third pole smooths its
    // steps
    const double corner = 2.0 * std::numbers::pi * settings_.acceleration_bandwidth;
    const double pole = 1.0 - std::exp(-corner * dt);
    slow_ += pole * (pose - slow_);
    slower_ += pole * (slow_ - slower_);
    const Vec3 raw = corner * corner * (pose - 2.0 * slow_ + slower_);
    acceleration_ += pole * (raw - acceleration_);
}

void Compensation::book(const PantographState& state, const JointVector& error, double dt) {
    const MotorFigures& motor = kinematics_.geometry().motor;
    // heat of friction, from below
    double heat = 0.0;
    const JointVector& angles = past(0).angles;
    for (int i = 0; i < kinematics_.motors(); ++i) {
        const double before = sure_angles_[i];
        sure_angles_[i] = std::clamp(before, angles[i] - error[i], angles[i] + error[i]);
        heat += motor.viscous_friction * dt * rates_[i] * rates_[i] +
                motor.coulomb_friction * std::abs(sure_angles_[i] - before);
    }
    reserve_ += std::max(0.0, 1.0 - k_model_error - settings_.friction_share) * heat;

    // work of what acted since the last reading, and what rounding may hide of it
    const double late = std::clamp(settings_.delay / dt, 0.0, k_delay - 2.0);
    const int whole = static_cast<int>(late);
    const double part = late - whole;
    const Sent& newer = sent(whole);
    const Sent& older = sent(whole + 1);
    const double potential = gravity_potential(kinematics_, state.pose, state, settings_.gravity);
    const auto work = [&](const Sent& s) {
        return s.share * (s.torque.dot(angles - last_angles_) - (potential - last_potential_));
    };
    reserve_ -= (1.0 - part) * work(newer) + part * work(older);
    reserve_ -= (newer.share * newer.torque - older.share * older.torque).cwiseAbs().dot(error);
    reserve_ = std::min(reserve_, settings_.energy_reserve);
    last_pose_ = state.pose;
    last_angles_ = angles;
    last_potential_ = potential;
}

void Compensation::start(const PantographState& state, const JointVector& angles, const JointVector& error) {
    reset();
    started_ = true;
    sure_angles_ = angles;
    last_angles_ = angles;
    // the first run of the play may begin half a reading error too far
    reserve_ = -kinematics_.geometry().motor.coulomb_friction * error.sum();
    last_pose_ = state.pose;
    last_potential_ = gravity_potential(kinematics_, state.pose, state, settings_.gravity);
    slow_ = state.pose;
    slower_ = state.pose;
}

JointVector Compensation::resolve(const PantographState& state, const Wrench& wrench) const {
    const TorqueSolution found = joint_torques(kinematics_, state, wrench);
    return found.scale > 0.0 ? JointVector(found.torque / found.scale) : JointVector(JointVector::Zero());
}

Wrench Compensation::update(const Pose& pose, const JointVector* angles, double dt) {
    const PantographState state = kinematics_.locate(pose);
    const bool usable = std::isfinite(dt) && dt > 0.0 && dt < k_longest_gap && state.reachable &&
                        (angles == nullptr || angles->head(kinematics_.motors()).allFinite());
    if (!usable) {
        reset();
        return Wrench::Zero();
    }
    JointVector now = JointVector::Zero();
    JointVector error = JointVector::Zero();
    if (angles != nullptr) {
        now.head(kinematics_.motors()) = angles->head(kinematics_.motors());
        error.head(kinematics_.motors())
            .setConstant(std::numbers::pi / kinematics_.geometry().motor.counts_per_revolution);
    } else {
        kinematics_.inverse(pose, now);
        error = state.rates.cwiseAbs() * reading_error_;
    }
    if (!started_)
        start(state, now, error);
    estimate_rates(now, error, dt);
    estimate_acceleration(state.pose, dt);
    const Pose moved = state.pose - last_pose_;
    book(state, error, dt);
    twist_ = kinematics_.jacobian(state) * rates_;

    // the weight is held by the torques that hold it in the middle of the time in which they act: where the
    // last move alone leads, since a lag costs more here than rounding does
    const double lead = 0.5 + settings_.delay / dt;
    PantographState ahead = kinematics_.locate(state.pose + lead * moved);
    if (!ahead.reachable)
        ahead = state;
    const JointVector holding = resolve(ahead, -gravity_wrench(kinematics_, ahead, settings_.gravity));
    gravity_ = state.rates.transpose() * holding;

    const MotorFigures& motor = kinematics_.geometry().motor;
    JointVector torque = JointVector::Zero();
    for (int i = 0; i < kinematics_.motors(); ++i)
        torque[i] = motor.viscous_friction * rates_[i] +
                    motor.coulomb_friction * std::clamp(rates_[i] / settings_.coulomb_rate, -1.0, 1.0);
    friction_ = settings_.friction_share * (state.rates.transpose() * torque);

    inertia_.setZero();
    allowed_ = 1.0;
    const Mat3 mass = handle_mass_matrix(kinematics_, state);
    if (settings_.inertia_share > 0.0) {
        inertia_ =
            settings_.inertia_share * (mass * acceleration_ + velocity_wrench(kinematics_, state, twist_));
        // at most: the rates are pulled towards zero and half a window old
        const JointVector by_joint = resolve(state, inertia_);
        const double power = inertia_.dot(twist_) + by_joint.cwiseAbs().dot(2.0 / span_ * error) +
                             std::max(0.0, inertia_.dot(acceleration_)) * span_;
        if (settings_.budgeted && power > 0.0)
            allowed_ = std::clamp(reserve_ / (power * k_horizon), 0.0, 1.0);
        inertia_ *= allowed_;
    }
    // a debt is paid back by a light damping, but never by what would push the last move on
    repayment_.setZero();
    const Wrench momentum = mass * twist_;
    const double swing = momentum.dot(twist_);
    if (settings_.budgeted && reserve_ < 0.0 && swing > 0.0 && momentum.dot(moved) > 0.0)
        repayment_ = -std::min(k_repayment_rate, -reserve_ / (k_horizon * swing)) * momentum;

    if (kinematics_.freedoms() == 2) {
        repayment_.z() = 0.0;
        gravity_.z() = 0.0;
        friction_.z() = 0.0;
        inertia_.z() = 0.0;
    }
    newest_sent_ = (newest_sent_ + 1) % k_delay;
    sent_[static_cast<std::size_t>(newest_sent_)] = {resolve(state, inertia_ + gravity_ + repayment_), 1.0};
    return gravity_ + friction_ + inertia_ + repayment_;
}

} // namespace haptics
