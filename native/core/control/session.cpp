// The haptic step.
//
// The gate comes after the model, so what it takes away is known one step late: `share_`, the part of the
// last command that was let through, scales coupling and hand force in the next step, so that device and
// proxy always receive opposite forces. The command itself is computed at full share; otherwise the gate's
// cut would be applied twice. Ramp, pause and disarming are no such cut: they take the force off the hand,
// and the proxy goes on being held, or it would fall away under its weight and never be armed.
//
// Impulses. If device and proxy were one body, a collision that changes the grip's velocity by dv would need
// M_d dv on the device's side (with the S form: L = S J_h D^-1 P = M_d dv for the combined impulse P). Eq.
// (7) with the proxy's own inertia gives the same for equal masses, throws a device that is lighter than the
// proxy back, and hardly stops one that is heavier. So M_d dv is what the hand receives.

#include <haptics/core/control/coupling_design.hpp>
#include <haptics/core/control/session.hpp>

#include <algorithm>
#include <cmath>

namespace haptics {
namespace {

// part of the command that clamps and limits let through, leaving out ramp and pause
double pass_fraction(const Wrench& command, const GateOutput& gate, double last) {
    if (gate.fade <= 0.0)
        return 1.0;
    const double size = command.squaredNorm();
    if (size < 1e-18)
        return last;
    return std::clamp(gate.applied.dot(command) / (gate.fade * size), 0.0, 1.0);
}

// hidden inertia fades out and in, s
constexpr double k_reveal_time = 0.004;
constexpr double k_hide_time = 0.1;
// What the gate faded comes back in k_return s once the coupling holds less than k_slack J, else within
// k_patience s, or a weight would stay light for ever.
double most_return(double tension, double step) {
    constexpr double k_return = 0.1;
    constexpr double k_patience = 30.0;
    constexpr double k_slack = 2e-5;
    const double part = k_slack / std::max(tension, k_slack);
    return step / k_patience + step / k_return * part * part;
}

// of a spring that gives at most `most`: what is beyond slips
double spring_energy(const Vec3& stiffness, const Vec3& stretch, const Wrench& most) {
    double energy = 0.0;
    for (int i = 0; i < 3; ++i) {
        const double force = std::min(stiffness(i) * std::abs(stretch(i)), most(i));
        energy += stiffness(i) > 0.0 ? 0.5 * force * force / stiffness(i) : 0.0;
    }
    return energy;
}

} // namespace

void Session::arm() {
    arm_wanted_ = true;
    forgive_ = gate_.faults();
}

void Session::disarm() {
    arm_wanted_ = false;
    forgive_ = Fault::none;
    gate_.disarm();
}

void Session::shut_off() {
    disarm();
    device_.write(Wrench::Zero());
}

// arms by itself only where nothing ever went wrong; a fault takes an explicit arm() that came after its
// cause was gone and the device was homed
void Session::try_to_arm(Fault device) {
    if (!arm_wanted_ || gate_.armed() || (gate_.faults() != Fault::none && gate_.faults() != forgive_))
        return;
    arm_result_ = device != Fault::none ? ArmResult::remove_the_cause_first : gate_.arm(output_.contacts > 0);
    if (arm_result_ == ArmResult::remove_the_cause_first || arm_result_ == ArmResult::home_the_device_first)
        forgive_ = Fault::none;
    if (arm_result_ != ArmResult::armed)
        return;
    forgive_ = Fault::none;
    ledger_.reset(reading_.pose, stored_energy());
    passivity_.reset();
}

double Session::coupling_energy(double most_force, double most_torque) const {
    if (firmness_ < 1.0)
        return 0.0;
    Vec3 stretch = target() - grip_pose(data_->grip, data_->pose);
    if (!data_->grip.pose)
        stretch.z() = 0.0; // the angle is free
    return spring_energy(gains_.stiffness, stretch, Wrench(most_force, most_force, most_torque));
}

// Of what lies between hand and tool the hand's part is counted, which is what the gate lets through.
double Session::stored_energy() const {
    const double most = gate_.limits().max_force / settings_.mapping.scale;
    // what the force channels lend the pair while it moves comes back once both have stopped
    const auto lent_to = [&](const Mat3& mass, Twist moving) {
        if (!data_->grip.pose)
            moving.z() = 0.0;
        return 0.5 * moving.dot(mass * moving);
    };
    double lent = lent_to(lent_.device, handle_velocity_);
    // a velocity from differences lags by about a step
    if (!reading_.has_velocity && !observer_)
        lent = std::max(lent, lent_to(lent_.device, 2.0 * handle_velocity_ - sampled_velocity_));
    lent += lent_to(lent_.tool, grip_velocity_);
    const double spring = share_ * grasp_.share() * coupling_energy(most, gate_.limits().max_torque);
    return output_.stored_energy + gate_fade_ * (spring - lent);
}

// What moves the handle's end of the coupling and is not the hand: all of it but the hand's share, and the
// turn. What the gate fades is held by nobody's energy: so much of the tool's part is not the hand's.
void Session::book_own_work() {
    source_work_ += output_.source_work;
    const Pose now = target();
    const Wrench force = share_ * grasp_.share() * output_.full_coupling;
    const double others = (1.0 - placement_.share()) * force.dot(now - last_target_);
    const double turned = placement_.share() * force.z() * settings_.step * placement_.turn().rate();
    const Pose moved = grip_pose(data_->grip, data_->pose) - last_grip_;
    grip_velocity_ = moved / settings_.step;
    source_work_ +=
        gate_fade_ * (others + turned) + (1.0 - gate_fade_) * (output_.coupling + fed_).dot(moved);
    last_target_ = now;
}

// A measured hand also pushes against the device's friction phi, and the force channels carry a part of that
// (coupling.cpp). The hand cannot get it back; it went into the friction. What moves M_d and is neither hand
// nor motor is phi. (An observer counts friction as the hand's: nothing is passed on then.)
double Session::friction_work() {
    const Mapping& map = settings_.mapping;
    const Pose moved = map.to_scene(reading_.pose) - map.to_scene(sampled_);
    const Twist faster = handle_velocity_ - sampled_velocity_;
    sampled_ = reading_.pose;
    sampled_velocity_ = handle_velocity_;
    if (!reading_.has_hand_force || !reading_.hand_force.allFinite())
        return 0.0;
    const double time = force_count_ * settings_.step;
    const Wrench hand = 0.5 * (sampled_hand_ + reading_.hand_force);
    sampled_hand_ = reading_.hand_force;
    Wrench friction = map.wrench_to_scene(hand + ledger_.force()) - device_mass_ * faster / time;
    if (!data_->grip.pose)
        friction.z() = 0.0;
    return gate_fade_ * (lent_.friction * friction).dot(moved);
}

bool Session::is_transparent() const {
    return settings_.hand_force == HandForce::transparent && feeds_forward();
}

// Hidden inertia fades out at once when something is touched, and comes back slowly. What the device is fed
// moves it while it acts, and the coupling is solved for the end of the step with that in it.
void Session::share(HandInput& hand) {
    const double h = settings_.step;
    const bool touches = output_.contacts > 0 || output_.colliding > 0;
    hiding_ = std::clamp(hiding_ + (touches ? -h / k_reveal_time : h / k_hide_time), 0.0, 1.0);
    mobility_ = grip_mobility(*model_, *data_);
    const Vec3 bias = free_grip_acceleration(*model_, *data_);
    const Mat3 visible = visible_mass(device_mass_, mobility_, hidden_, hiding_);
    const double passes = share_ * grasp_.share() * channels();
    // what a clamp takes for a moment is no reason to forget a debt
    lent_ = lent_mass_hidden(mobility_, device_mass_,
                             grasp_.share() * channels() * placement_.share() * (device_mass_ - visible));
    shared_ = share_motion(mobility_, bias, device_mass_, visible, whole_hand_force());
    hand.force = passes * shared_.to_proxy;
    const Vec3 moved =
        observer_ ? Vec3(device_mass_.inverse() * (passes * shared_.to_device)) : Vec3(shared_.acceleration);
    hand.target += 0.5 * h * h * moved;
    hand.target_velocity += h * moved;
}

void Session::run_model() {
    const double h = settings_.step;
    if (settings_.coupling == Coupling::direct && !model_->tool.articulated) {
        HandInput at;
        at.target = handle_ + grab_offset_;
        at.target_velocity = handle_velocity_;
        place_target(at);
        const Pose center = center_pose(data_->grip, at.target);
        Twist velocity = at.target_velocity;
        const Vec2 arm = center.head<2>() - at.target.head<2>();
        velocity.head<2>() = velocity_at(at.target_velocity, arm);
        step_direct(*model_, *data_, center, velocity, h, output_);
        return;
    }
    HandInput hand;
    hand.held = grasp_.share() > 0.0;
    hand.target = handle_ + grab_offset_ + h * handle_velocity_;
    hand.target_velocity = handle_velocity_;
    const bool holds = firmness_ >= 1.0;
    const CouplingGains gains{holds ? gains_.stiffness : Vec3(Vec3::Zero()), firmness_ * gains_.damping};
    hand.stiffness = gains.stiffness;
    hand.damping = gains.damping;
    if (observer_ && observer_->started()) {
        // the handle yields to the force while it acts (coupling_design.cpp)
        const Mat3 yielding = device_mass_.inverse();
        hand.target = settings_.mapping.to_scene(observer_->pose_ahead()) + grab_offset_;
        hand.target_velocity = settings_.mapping.twist_to_scene(observer_->twist_ahead());
        for (int i = 0; i < 3; ++i) {
            const SolverGains solver = solver_gains(gains.stiffness(i), gains.damping(i), yielding(i, i), h);
            hand.stiffness(i) = solver.stiffness;
            hand.damping(i) = solver.damping;
        }
    }
    place_target(hand);
    hand.max_force = gate_.limits().max_force / settings_.mapping.scale;
    hand.max_torque = gate_.limits().max_torque;
    hand.share = share_ * grasp_.share();
    felt_mass_ = settings_.hand_force == HandForce::paper ? truncated_mass(mobility_, device_mass_)
                                                          : combined_mass(mobility_, device_mass_);
    if (is_transparent())
        share(hand);
    else if (feeds_forward()) {
        const double passes = share_ * grasp_.share() * channels();
        lent_ = lent_mass(mobility_, device_mass_, grasp_.share() * channels() * placement_.share());
        hand.force = passes * (settings_.hand_force == HandForce::paper
                                   ? whole_hand_force()
                                   : Wrench(felt_mass_ * mobility_ * whole_hand_force()));
    }
    fed_ = hand.force;
    haptics::step(*model_, *data_, hand, h, output_);
    mobility_ = output_.grip_mobility;
}

Wrench Session::command() {
    if (grasp_.share() == 0.0) {
        impulses_.drop();
        return Wrench::Zero();
    }
    if (settings_.coupling == Coupling::direct)
        return grasp_.share() * channels() * placement_.share() * output_.environment;
    Wrench force = -output_.full_coupling;
    if (is_transparent())
        force += channels() * shared_.to_device;
    else if (feeds_forward())
        force +=
            channels() * felt_mass_ *
            (settings_.hand_force == HandForce::paper ? output_.grip_acceleration
                                                      : Vec3(output_.grip_acceleration + output_.grip_bias));
    force *= grasp_.share() * placement_.share();
    if (held_ && !output_.grip_velocity_jump.isZero(0.0))
        impulses_.demand((settings_.hand_force == HandForce::paper ? felt_mass_ : device_mass_) *
                         (channels() * placement_.share() * output_.grip_velocity_jump));
    if (output_.contacts == 0 && output_.colliding == 0 && output_.grip_velocity_jump.isZero(0.0))
        impulses_.drop();
    const SafetyLimits& limits = gate_.limits();
    // what the other channels leave of the device's force
    const double room = limits.max_force / settings_.mapping.scale - force.head<2>().norm();
    report_.impulse_force = impulses_.deliver(settings_.step, room, limits.max_torque - std::abs(force.z()));
    return force + report_.impulse_force;
}

void Session::step() {
    read_device();
    if (fresh_) {
        const double stored = stored_energy();
        if (force_count_ > 0.0)
            source_work_ += friction_work();
        if (gate_.armed())
            ledger_.book(reading_.pose, stored, source_work_);
        source_work_ = 0.0;
        force_sum_.setZero();
        force_count_ = 0.0;
    }
    const Mat3 handle_mass = device_.handle_mass(reading_.pose);
    device_mass_ = settings_.mapping.mass_to_scene(handle_mass);
    grasp();
    place_handle();
    run_model();
    book_own_work();
    const Wrench force = command();
    // disarmed the compensation is no command either: arming asks for free space
    Wrench wanted = Wrench::Zero();
    if (gate_.armed())
        wanted = settings_.mapping.wrench_to_device(force) + care_.wrench();
    const Twist device_twist = settings_.mapping.twist_to_device(handle_velocity_);
    // hidden inertia is moved by an estimate that is late, which is a negative damper
    const bool controls = settings_.passivity_control || (is_transparent() && hiding_ >= 1.0);
    if (controls && gate_.armed())
        wanted += passivity_.damp(ledger_.created(), wanted, device_twist, handle_mass, settings_.step);
    gate_.limit_return(most_return(coupling_energy(HUGE_VAL, HUGE_VAL), settings_.step));
    const Fault device = device_faults();
    gate_.raise(device);
    try_to_arm(device);
    const GateOutput gated = gate_.apply(wanted, reading_.pose, device_twist, settings_.step);
    share_ = pass_fraction(wanted, gated, share_);
    // ramp and pause change by order: what they hand over is no energy out of nothing
    if (gated.ramp != gate_ramp_ && gate_ramp_ > 0.0) {
        const double before = stored_energy();
        gate_fade_ *= gated.ramp / gate_ramp_;
        source_work_ += stored_energy() - before;
    }
    gate_ramp_ = gated.ramp;
    gate_fade_ = gated.fade;
    care_.sent(wanted, gated.applied);
    device_.write(gated.applied);
    if (observer_)
        observer_->sent(gated.applied, handle_mass);
    // the handle felt all forces since its last sample; the compensation keeps its own books
    force_sum_ += gated.applied - care_.applied();
    force_count_ += 1.0;
    ledger_.set_force(force_sum_ / force_count_);
    device_.advance(settings_.step);
    write_report(gated, wanted);
}

} // namespace haptics
