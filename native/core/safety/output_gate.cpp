// Order of one step: faults -> ramp, pause -> workspace, singularity and speed fades -> force clamp -> slew
// limit -> fade limits once more -> motor clamp. Clamps and fades scale the whole wrench, so that its
// direction in (x, y, theta) stays.
//
// Slew limit. A change dF of the output, held for dt, gives a mass M the impulse dF dt and so, beyond what
// the old output did,
//   dE = dt dF . v + dt^2/2 dF . M^-1 dF.
// A change with dE <= 0 takes energy out of the handle in this very step: it passes whole. That is every
// collision impulse with a restitution of at most 1, since p = (1 + e) m v opposes v with p^2 / 2m <= p v.
// Otherwise the largest share a of the change with a <= 0 crossing,  a = -2 dF . v / (dt dF . M^-1 dF),
// passes, or the share that the slew limits allow, whichever is larger. At rest nothing opposes motion, so
// every change counts as adding power. A force that vanishes (|F'| <= |F| along F) still obeys this: dropping
// a braking force adds power as well, and takes at most a few milliseconds.
//
// The force sent after the slew limit is a mean of the last output and the clamped command; both satisfy the
// clamps (a convex set), so it does too. Fades and motors change with the pose, so they are applied to the
// result as the last word.

#include <haptics/core/pantograph/torque_map.hpp>
#include <haptics/core/safety/output_gate.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace haptics {

namespace {

// share of a wrench that fits the force and torque limit
double share_within(const Wrench& wrench, double force, double torque) {
    const double f = wrench.head<2>().norm();
    const double t = std::abs(wrench.z());
    double share = 1.0;
    if (f > force)
        share = force / f;
    if (t * share > torque)
        share = torque / t;
    return share;
}

// a step longer than this is a stall; slew and ramps do not run on through it
constexpr double k_longest_step = 0.01;
// inputs that the rest of a step cannot be computed from
constexpr Fault k_bad_input = Fault::fix_the_controller | Fault::check_the_encoders | Fault::restart_the_loop;
// commands beyond this are cut first, so that no square overflows (N)
constexpr double k_absurd = 1.0e9;

} // namespace

const char* describe_arming(ArmResult result) {
    switch (result) {
    case ArmResult::home_the_device_first:
        return "Bring the handle into its home pose and call home_device().";
    case ArmResult::hold_the_handle_still:
        return "Hold the handle still for a moment.";
    case ArmResult::leave_contact:
        return "Move the tool out of contact.";
    case ArmResult::remove_the_cause_first:
        return "Remove the cause of the fault first.";
    case ArmResult::armed:
    case ArmResult::already_armed:
        break;
    }
    return "";
}

OutputGate::OutputGate(const SafetyLimits& limits)
    : limits_(limits) {}

OutputGate::OutputGate(const SafetyLimits& limits, const PantographKinematics& kinematics)
    : limits_(limits)
    , kinematics_(kinematics) {}

void OutputGate::shut() {
    applied_.setZero();
    ramp_ = 0.0;
    place_fade_ = 1.0;
    energy_ = 0.0;
}

void OutputGate::raise(Fault fault) {
    if (fault == Fault::none)
        return;
    faults_ = faults_ | fault;
    armed_ = false;
    shut();
}

void OutputGate::disarm() {
    armed_ = false;
    shut();
}

void OutputGate::set_homed(bool homed) {
    homed_ = homed;
    if (!homed)
        disarm();
}

ArmResult OutputGate::arm(bool touching) {
    if (armed_)
        return ArmResult::already_armed;
    if (!homed_)
        return ArmResult::home_the_device_first;
    if (present_ != Fault::none)
        return ArmResult::remove_the_cause_first;
    if (at_rest_for_ < limits_.rest_time)
        return ArmResult::hold_the_handle_still;
    if (touching || !command_small_)
        return ArmResult::leave_contact;
    faults_ = Fault::none;
    too_fast_for_ = 0.0;
    shut();
    armed_ = true;
    return ArmResult::armed;
}

Fault OutputGate::find_fault(const Wrench& command, const Pose& pose, const Twist& twist, double dt) {
    Fault found = Fault::none;
    if (!command.allFinite())
        found = found | Fault::fix_the_controller;
    if (!pose.allFinite() || !twist.allFinite())
        found = found | Fault::check_the_encoders;
    if (!std::isfinite(dt) || !(dt > 0.0))
        found = found | Fault::restart_the_loop;
    if (found != Fault::none)
        return found;

    const bool fast =
        twist.head<2>().norm() > limits_.max_speed || std::abs(twist.z()) > limits_.max_angular_speed;
    too_fast_for_ = fast ? too_fast_for_ + std::min(dt, k_longest_step) : 0.0;
    if (fast && too_fast_for_ >= limits_.speed_patience)
        found = found | Fault::move_slower_or_soften_the_coupling;

    // what the last output did until now
    if (has_last_pose_) {
        energy_ += applied_.dot(pose - last_pose_);
        energy_ *= std::exp(-dt / limits_.energy_window);
        energy_ = std::isfinite(energy_) ? std::max(energy_, -limits_.max_energy) : 2.0 * limits_.max_energy;
        if (energy_ > limits_.max_energy)
            found = found | Fault::soften_the_coupling_or_add_damping;
    }

    if (kinematics_) {
        state_ = kinematics_->locate(pose);
        workspace_ = kinematics_->workspace(pose, state_);
        if (!(workspace_.reach_margin > -limits_.workspace_overrun))
            found = found | Fault::bring_the_handle_back_into_the_workspace;
    }
    return found;
}

void OutputGate::watch_rest(const Wrench& command, const Twist& twist, double dt) {
    const bool still =
        twist.head<2>().norm() <= limits_.rest_speed && std::abs(twist.z()) <= limits_.rest_angular_speed;
    at_rest_for_ = still ? at_rest_for_ + std::min(dt, k_longest_step) : 0.0;
    command_small_ =
        command.head<2>().norm() <= limits_.arming_force && std::abs(command.z()) <= limits_.arming_torque;
}

double OutputGate::change_fraction(const Wrench& change, const Twist& twist, double dt) const {
    const double allowed = share_within(change, limits_.force_slew * dt, limits_.torque_slew * dt);
    if (allowed >= 1.0)
        return 1.0;
    const double power = change.dot(twist);
    if (!(power < 0.0))
        return allowed;
    const double given = dt * (change.head<2>().squaredNorm() / limits_.reference_mass +
                               change.z() * change.z() / limits_.reference_inertia);
    const double opposing = given > 0.0 ? -2.0 * power / given : 1.0;
    return std::clamp(std::max(allowed, opposing), 0.0, 1.0);
}

GateOutput OutputGate::apply(const Wrench& command, const Pose& pose, const Twist& twist, double dt) {
    GateOutput out;
    present_ = find_fault(command, pose, twist, dt);
    const bool usable = !has(present_, k_bad_input);
    if (usable) {
        watch_rest(command, twist, dt);
        last_pose_ = pose;
    } else {
        at_rest_for_ = 0.0;
    }
    has_last_pose_ = usable;
    if (armed_ && present_ != Fault::none)
        raise(present_);

    // pausing goes on while disarmed
    const double step = usable ? std::min(dt, k_longest_step) : 0.0;
    const double towards = paused_ ? -1.0 : 1.0;
    open_ = std::clamp(open_ + towards * step / limits_.pause_fade_time, 0.0, 1.0);
    out.faults = faults_;
    if (!armed_) {
        shut();
        out.flags = GateFlag::disarmed | (faults_ != Fault::none ? GateFlag::faulted : GateFlag::none);
        return out;
    }

    const auto mark = [&out](bool condition, GateFlag flag) {
        if (condition)
            out.flags = out.flags | flag;
    };
    // ramp and pause
    ramp_ = std::min(1.0, ramp_ + step / limits_.ramp_time);
    mark(ramp_ < 1.0, GateFlag::ramping);
    mark(open_ < 1.0, GateFlag::paused);
    double fade = ramp_ * open_;
    out.ramp = fade;

    // near the edge and near singular poses
    if (kinematics_) {
        double edge = std::clamp(workspace_.reach_margin / limits_.workspace_fade, 0.0, 1.0);
        if (kinematics_->freedoms() == 3) {
            const double rotation_fade = limits_.workspace_fade / kinematics_->characteristic_length();
            edge = std::min(edge, std::clamp(workspace_.rotation_margin / rotation_fade, 0.0, 1.0));
        }
        if (!state_.reachable)
            edge = 0.0;
        const double half = 0.5 * limits_.singularity_fade;
        const double singular = std::clamp((workspace_.singularity - half) / half, 0.0, 1.0);
        place_fade_ = std::min(edge * singular, place_fade_ + most_return_);
        mark(singular < 1.0, GateFlag::singularity_faded);
        mark(edge < 1.0 || (place_fade_ < 1.0 && singular >= 1.0), GateFlag::workspace_faded);
        fade *= place_fade_;
    }
    out.fade = fade;

    // force clamp
    Wrench wanted = command.cwiseMax(-k_absurd).cwiseMin(k_absurd) * fade;
    const double fits = share_within(wanted, limits_.max_force * fade, limits_.max_torque * fade);
    mark(fits < 1.0, GateFlag::force_clamped);
    wanted *= fits;

    // fast already: nothing that drives it further
    const double speed =
        std::max(twist.head<2>().norm() / limits_.max_speed, std::abs(twist.z()) / limits_.max_angular_speed);
    if (speed > 0.8 && wanted.dot(twist) > 0.0) {
        wanted *= std::clamp(5.0 * (1.0 - speed), 0.0, 1.0);
        mark(true, GateFlag::speed_faded);
    }

    // slew
    const Wrench change = wanted - applied_;
    const double fraction = change_fraction(change, twist, step);
    mark(fraction < 1.0, GateFlag::slew_limited);
    Wrench sent = fraction < 1.0 ? Wrench(applied_ + fraction * change) : wanted;
    sent *= share_within(sent, limits_.max_force * fade, limits_.max_torque * fade);

    // motors
    if (kinematics_) {
        const double share = joint_torques(*kinematics_, state_, sent).scale;
        mark(share < 1.0, GateFlag::motor_clamped);
        sent *= share;
    }
    if (!sent.allFinite())
        sent.setZero();
    applied_ = sent;
    out.applied = sent;
    return out;
}

} // namespace haptics
