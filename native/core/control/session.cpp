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
#include <numbers>
#include <utility>

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

// beyond any device, m and m/s, N
constexpr double k_beyond_device = 1e4;

template <class Vector>
bool is_below(const Vector& v, double most) {
    return (v.cwiseAbs().array() < most).all(); // false for what is not a number
}

Fault without(Fault set, Fault bits) {
    return static_cast<Fault>(static_cast<std::uint32_t>(set) & ~static_cast<std::uint32_t>(bits));
}

bool is_true_reading(const DeviceReading& r) {
    return is_below(r.pose, k_beyond_device) && (!r.has_velocity || is_below(r.velocity, k_beyond_device));
}

// a handle is moved on by its velocity for so long, s; beyond that the velocity says too little
constexpr double k_most_ahead = 0.003;

// hidden inertia fades out and in, s
constexpr double k_reveal_time = 0.004;
constexpr double k_hide_time = 0.1;

// of a spring that gives at most `most`
double spring_energy(const Vec3& stiffness, const Vec3& stretch, const Wrench& most) {
    double energy = 0.0;
    for (int i = 0; i < 3; ++i) {
        const double force = std::min(stiffness(i) * std::abs(stretch(i)), most(i));
        energy += stiffness(i) > 0.0 ? 0.5 * force * force / stiffness(i) : 0.0;
    }
    return energy;
}

} // namespace

std::vector<FigureError> validate(const SessionSettings& s) {
    FigureCheck check;
    check.range("rate", s.step > 0.0 ? 1.0 / s.step : 0.0, 250.0, 100000.0, "Hz",
                "1000 Hz is the default; above 10000 Hz only in lock-step.");
    check.append(validate(HandPlacement{s.mapping, false, 0.0}));
    for (int i = 0; i < 3; ++i) {
        check.range("coupling.stiffness", s.gains.stiffness(i), 0.0, 1e9, "N/m",
                    "0 chooses it from device mass and rate.");
        check.range("coupling.damping", s.gains.damping(i), 0.0, 1e9, "N s/m",
                    "0 chooses it from device mass and rate.");
        check.range("reading_error", s.reading_error(i), 0.0, 0.1, "m", "Half an encoder step.");
    }
    check.range("device_patience", s.device_patience, 0.002, 1.0, "s", "0.02 is the default.");
    check.range("velocity_window", static_cast<double>(s.velocity_window), 1.0, 63.0, "samples",
                "2 is the default.");
    check.range("observer.delay", s.observer.delay, 0.0, HandleObserver::k_most_delay * s.step, "s",
                "The time from a reading to the force that answers it.");
    check.range("observer.bandwidth", s.observer.bandwidth, 0.0, 1e5, "rad/s", "0 chooses it.");
    check.range("observer.rotation_bandwidth", s.observer.rotation_bandwidth, 0.0, 1e5, "rad/s",
                "0 chooses it.");
    check.range("observer.noise", s.observer.noise, 0.001, 10.0, "N", "0.05 is the default.");
    check.range("observer.mass_error", s.observer.mass_error, 0.0, 0.5, "", "0.25 is the default.");
    check.range("hidden_inertia", s.hidden_inertia, 0.0, 0.95, "", "0 leaves all of it to the hand.");
    check.range("device_delay", s.device_delay, 0.0, 1.0, "s", "Most devices add less than 0.001 s.");
    return check.take();
}

std::vector<FigureError> validate(const SessionSettings& s, const Model& model) {
    FigureCheck check;
    check.append(validate(s));
    if (model.tool.articulated && s.coupling == Coupling::direct)
        check.inconsistent(
            "coupling", 2.0, 0.0, 1.0, "(0 four_channel, 1 virtual_coupling, 2 direct)",
            "Direct rendering needs a rigid tool: a linkage's joints do not follow from the handle.");
    return check.take();
}

Session::Session(const SessionSettings& settings, const Model& model, const OutputGate& gate,
                 DevicePort& device, const LinkageVector& start)
    : settings_(settings)
    , model_(std::make_unique<Model>(model))
    , data_(std::make_unique<Data>())
    , gate_(gate)
    , device_(device)
    , care_(settings.care, gate, settings.reading_error)
    , velocity_(settings.reading_error, settings.velocity_window)
    , passivity_(settings.reading_error)
    , placement_(HandPlacement{settings.mapping, false, 0.0}) {
    reset(*model_, *data_, start);
    arm_wanted_ = settings.arm_at_start;
    mobility_ = grip_mobility(*model_, *data_);
    read_device();
    device_mass_ = settings_.mapping.mass_to_scene(device_.handle_mass(reading_.pose));
    choose_gains();
    hold(settings_.hold_at_start);
    report_.grip = grip_pose(data_->grip, data_->pose);
    report_.proxy = data_->pose;
    report_.device = target();
    report_.held = held_;
    report_linkage();
}

// in the device's axes; the scene sees forces divided by the scale and motions multiplied by it
void Session::choose_gains() {
    gains_ = settings_.gains;
    const bool chosen = !gains_.stiffness.isZero(0.0) || !gains_.damping.isZero(0.0);
    gains_follow_scale_ = !chosen;
    hidden_ = {Vec3::Constant(settings_.hidden_inertia), settings_.hidden_inertia};
    if (settings_.observer.enabled && observe(chosen))
        return;
    if (!chosen)
        gains_ = default_gains(device_mass_, loop_mobility(), settings_.step, settings_.device_delay,
                               settings_.velocity_window);
}

// false when no coupling holds with what the device is said to be
bool Session::observe(bool gains_chosen) {
    const ObserverSettings& wanted = settings_.observer;
    const Mat3 mass = device_.handle_mass(reading_.pose);
    LoopFigures figures;
    figures.step = settings_.step;
    figures.delay = wanted.delay;
    figures.mass_error = wanted.mass_error;
    figures.four_channel = settings_.coupling == Coupling::four_channel;
    figures.transparent = settings_.hand_force == HandForce::transparent;
    figures.hidden = settings_.hidden_inertia;
    figures.mass = lightest_mass(mass);
    figures.quantum = 2.0 * settings_.reading_error.head<2>().maxCoeff();
    figures.noise = wanted.noise;
    const CouplingDesign translation = design_coupling(figures);
    figures.mass = mass(2, 2);
    figures.quantum = 2.0 * settings_.reading_error.z();
    figures.noise = wanted.noise * ObserverSettings::k_arm;
    figures.hand_stiffness = 2.0;
    figures.hand_damping = 0.02;
    const CouplingDesign rotation = design_coupling(figures);
    if (translation.stiffness == 0.0 || rotation.stiffness == 0.0)
        return false;
    hidden_.alone = Vec3(translation.hidden, translation.hidden, rotation.hidden);
    if (!gains_chosen) {
        const double scale = settings_.mapping.scale * settings_.mapping.scale;
        gains_.stiffness =
            Vec3(translation.stiffness / scale, translation.stiffness / scale, rotation.stiffness);
        gains_.damping = Vec3(translation.damping / scale, translation.damping / scale, rotation.damping);
    }
    const double along = wanted.bandwidth > 0.0 ? wanted.bandwidth : translation.bandwidth;
    const double around = wanted.rotation_bandwidth > 0.0 ? wanted.rotation_bandwidth : rotation.bandwidth;
    observer_.emplace(settings_.step, wanted.delay, Vec3(along, along, around));
    observer_->sent(Wrench::Zero(), mass);
    return true;
}

void Session::hold(bool held) {
    if (held && grasp_ == 0.0)
        freeze_offset();
    held_ = held;
    regrab_ = false;
    impulses_.drop();
}

void Session::freeze_offset() {
    grab_offset_ = grip_pose(data_->grip, data_->pose) - handle_ - turned();
    parked_ = false;
}

void Session::grasp() {
    const double change = settings_.step / k_grasp_time;
    grasping_ = std::clamp(grasping_ + (held_ ? change : -change), 0.0, 1.0);
    grasp_ = grasping_ * grasping_ * (3.0 - 2.0 * grasping_); // no kink at either end
    if (regrab_ && grasp_ == 0.0) {
        haptics::grab(*model_, *data_, next_grip_);
        mobility_ = grip_mobility(*model_, *data_);
        hold(true);
    }
}

// Clutch, mapping and turn (placement.hpp). Parked, the tool is held where it was by the same coupling, of
// which the hand feels nothing.
void Session::place_handle() {
    placement_.advance(output_.full_coupling.head<2>().norm(), settings_.step);
    if (placement_.rests()) {
        if (!parked_)
            park_ = handle_ + grab_offset_;
        parked_ = true;
        const double before = settings_.mapping.scale;
        placement_.remap();
        settings_.mapping = placement_.mapping();
        if (gains_follow_scale_) {
            const double ratio = before / settings_.mapping.scale;
            gains_.stiffness.head<2>() *= ratio * ratio;
            gains_.damping.head<2>() *= ratio * ratio;
        }
        locate_handle();
    } else if (parked_) {
        grab_offset_ = park_ - handle_;
        parked_ = false;
    }
    hand_force_ *= placement_.share();
}

void Session::place_target(HandInput& hand) const {
    if (parked_) {
        hand.target = park_;
        hand.target_velocity.setZero();
    }
    hand.target += turned();
    hand.target.z() += settings_.step * placement_.turn().rate();
    hand.target_velocity.z() += placement_.turn().rate();
}

// What moves the handle's end of the coupling and is not the hand: all of it but the hand's share, and the
// turn.
void Session::book_own_work() {
    source_work_ += output_.source_work;
    const Pose now = target();
    const Wrench force = share_ * grasp_ * output_.full_coupling;
    const double others = (1.0 - placement_.share()) * force.dot(now - last_target_);
    const double turned = placement_.share() * force.z() * settings_.step * placement_.turn().rate();
    source_work_ += others + turned;
    last_target_ = now;
}

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

// Both force channels or none: the environment's alone would let the hand feel the contact once fed forward
// and once through the spring.
bool Session::feeds_forward() const {
    return settings_.coupling == Coupling::four_channel && (reading_.has_hand_force || observer_);
}

// a linkage can be light in some pose and stretched in another: its gains are those of the lightest proxy
Mat3 Session::loop_mobility() const {
    if (!feeds_forward())
        return Mat3::Zero();
    return model_->tool.articulated ? Mat3(1e12 * Mat3::Identity()) : mobility_;
}

double Session::stored_energy() const {
    const double force = gate_.limits().max_force / settings_.mapping.scale;
    const Vec3 stretch = target() - grip_pose(data_->grip, data_->pose);
    // what moves the hidden part of the device's inertia comes from the controller, and back to it
    return output_.stored_energy - 0.5 * grasp_ * handle_velocity_.dot(hidden_mass_ * handle_velocity_) +
           grasp_ * spring_energy(gains_.stiffness, stretch, Wrench(force, force, gate_.limits().max_torque));
}

void Session::read_device() {
    const std::uint64_t last = reading_.sequence;
    const double last_angle = reading_.pose.z();
    DeviceReading next = reading_;
    next.faults = without(next.faults, Fault::check_the_encoders);
    missing_ = !device_.read(next);
    if (!missing_ && is_true_reading(next)) {
        reading_ = std::move(next);
    } else if (!missing_) {
        // what is not a number would stay in the proxy for ever: such a reading counts as none
        missing_ = true;
        reading_.faults = reading_.faults | Fault::check_the_encoders;
    }
    fresh_ = !missing_ && (reading_.sequence != last || last == 0);
    // a device that found or lost its zero, or was away, may be anywhere
    const bool homed_anew = !missing_ && reading_.homings != homings_;
    const bool elsewhere = !missing_ && (homed_anew || reading_.homed != gate_.homed() ||
                                         (fresh_ && silent_for_ > settings_.device_patience));
    // an angle that the device wraps goes on growing here
    if (!missing_ && !elsewhere && last != 0)
        reading_.pose.z() =
            last_angle + std::remainder(reading_.pose.z() - last_angle, 2.0 * std::numbers::pi);
    if (elsewhere) {
        care_.restart();
        if (homed_anew) {
            homings_ = reading_.homings;
            care_.homed();
            gate_.set_homed(false);
        }
        gate_.set_homed(reading_.homed);
        velocity_.reset();
        if (observer_)
            observer_->reset();
        handle_velocity_.setZero();
    }
    follow_handle();
    if (elsewhere) {
        // the coupling starts anew, without tension
        grasp_ = 0.0;
        grasping_ = 0.0;
        freeze_offset();
    }
    hand_force_.setZero();
    if (reading_.has_hand_force && is_below(reading_.hand_force, k_beyond_device))
        hand_force_ = settings_.mapping.wrench_to_scene(reading_.hand_force);
    else if (observer_)
        hand_force_ = settings_.mapping.wrench_to_scene(observer_->hand_force());
}

void Session::follow_handle() {
    const Mapping& map = settings_.mapping;
    silent_for_ += settings_.step;
    age_ += settings_.step;
    if (fresh_) {
        const double interval = reading_.interval > 0.0 ? reading_.interval : silent_for_;
        silent_for_ = 0.0;
        age_ = reading_.age;
        care_.take(reading_, interval);
        if (observer_)
            observer_->correct(reading_.pose);
        handle_velocity_ = map.twist_to_scene(
            reading_.has_velocity ? reading_.velocity : velocity_.update(reading_.pose, interval));
    }
    // a device that fell silent stands still: the last push of the hand must not carry the tool on and on
    if (observer_ && silent_for_ > settings_.device_patience)
        observer_->reset();
    locate_handle();
}

void Session::locate_handle() {
    const Mapping& map = settings_.mapping;
    if (observer_ && observer_->started()) {
        handle_ = map.to_scene(observer_->pose());
        handle_velocity_ = map.twist_to_scene(observer_->twist());
        return;
    }
    handle_ = map.to_scene(reading_.pose);
    if (age_ > 0.0)
        handle_ += std::min(age_, k_most_ahead) * handle_velocity_;
}

Fault Session::device_faults() const {
    // half a step of slack: the sum of many steps is not exact
    const bool silent = silent_for_ > settings_.device_patience + 0.5 * settings_.step;
    return reading_.faults | care_.fault() | (silent ? Fault::reconnect_the_device : Fault::none);
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
    hidden_mass_ = device_mass_ - visible;
    shared_ = share_motion(mobility_, bias, device_mass_, visible, hand_force_);
    hand.force = hand.share * shared_.to_proxy;
    const Vec3 moved = observer_ ? Vec3(device_mass_.inverse() * (hand.share * shared_.to_device))
                                 : Vec3(shared_.acceleration);
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
    hand.held = grasp_ > 0.0;
    hand.target = handle_ + grab_offset_ + h * handle_velocity_;
    hand.target_velocity = handle_velocity_;
    hand.stiffness = gains_.stiffness;
    hand.damping = gains_.damping;
    if (observer_ && observer_->started()) {
        // the handle yields to the force while it acts (coupling_design.cpp)
        const Mat3 yielding = device_mass_.inverse();
        hand.target = settings_.mapping.to_scene(observer_->pose_ahead()) + grab_offset_;
        hand.target_velocity = settings_.mapping.twist_to_scene(observer_->twist_ahead());
        for (int i = 0; i < 3; ++i) {
            const SolverGains solver =
                solver_gains(gains_.stiffness(i), gains_.damping(i), yielding(i, i), h);
            hand.stiffness(i) = solver.stiffness;
            hand.damping(i) = solver.damping;
        }
    }
    place_target(hand);
    hand.max_force = gate_.limits().max_force / settings_.mapping.scale;
    hand.max_torque = gate_.limits().max_torque;
    hand.share = share_ * grasp_;
    felt_mass_ = settings_.hand_force == HandForce::paper ? truncated_mass(mobility_, device_mass_)
                                                          : combined_mass(mobility_, device_mass_);
    if (is_transparent())
        share(hand);
    else if (feeds_forward())
        hand.force = hand.share * (settings_.hand_force == HandForce::paper
                                       ? hand_force_
                                       : Wrench(felt_mass_ * mobility_ * hand_force_));
    haptics::step(*model_, *data_, hand, h, output_);
    mobility_ = output_.grip_mobility;
}

Wrench Session::command() {
    if (grasp_ == 0.0) {
        impulses_.drop();
        return Wrench::Zero();
    }
    if (settings_.coupling == Coupling::direct)
        return grasp_ * placement_.share() * output_.environment;
    Wrench force = -output_.full_coupling;
    if (is_transparent())
        force += shared_.to_device;
    else if (feeds_forward())
        force += felt_mass_ * (settings_.hand_force == HandForce::paper
                                   ? output_.grip_acceleration
                                   : Vec3(output_.grip_acceleration + output_.grip_bias));
    force *= grasp_ * placement_.share();
    if (held_ && !output_.grip_velocity_jump.isZero(0.0))
        impulses_.demand((settings_.hand_force == HandForce::paper ? felt_mass_ : device_mass_) *
                         (placement_.share() * output_.grip_velocity_jump));
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
        if (gate_.armed())
            ledger_.book(reading_.pose, stored_energy(), source_work_);
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
    if (settings_.passivity_control && gate_.armed())
        wanted += passivity_.damp(ledger_.created(), wanted, device_twist, handle_mass, settings_.step);
    const Fault device = device_faults();
    gate_.raise(device);
    try_to_arm(device);
    const GateOutput gated = gate_.apply(wanted, reading_.pose, device_twist, settings_.step);
    share_ = pass_fraction(wanted, gated, share_);
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

void Session::write_report(const GateOutput& gate, const Wrench& command) {
    report_linkage();
    const Mapping& map = settings_.mapping;
    HapticReport& r = report_;
    r.step = data_->step;
    r.time = data_->time;
    r.device = target();
    r.device_velocity = handle_velocity_;
    r.proxy = data_->pose;
    r.grip = grip_pose(data_->grip, data_->pose);
    r.velocity = data_->velocity;
    r.hand_share = grasp_ * placement_.share();
    r.force = map.wrench_to_scene(gate.applied);
    r.compensation = map.wrench_to_scene(care_.applied());
    r.command = map.wrench_to_scene(command);
    r.contact = output_.contact;
    r.coupling = output_.coupling;
    r.hand = hand_force_;
    r.impulse_demanded = impulses_.demanded();
    r.impulse_delivered = impulses_.delivered();
    r.impulse_dropped = impulses_.dropped();
    r.contacts = output_.contacts;
    r.colliding = output_.colliding;
    r.sticking = output_.sticking;
    r.sliding = output_.sliding;
    r.max_penetration = output_.max_penetration;
    r.energy_injected = ledger_.injected();
    r.held = held_;
    r.armed = gate_.armed();
    r.gate = gate.flags;
    r.faults = gate.faults;
    r.fallbacks += output_.fell_back ? 1U : 0U;
    r.exact_gave_way += output_.exact_gave_way ? 1U : 0U;
    r.patch_overflow = data_->patches.overflow;
    r.movable_overflow = data_->movable_overflow;
    r.reading_missing = missing_;
    r.buttons = reading_.buttons;
    r.contact_count = 0;
    for (int i = 0; i < data_->patches.count && r.contact_count < HapticReport::k_max_contacts; ++i) {
        const Patch& p = data_->patches.patch[static_cast<std::size_t>(i)];
        // movable neighbors touch others too; the list is the tool's
        if (p.memory.state == ContactState::none || p.body_a >= data_->tool.body_count ||
            p.body_b < data_->tool.body_count)
            continue;
        ContactReport& c = r.contact_list[static_cast<std::size_t>(r.contact_count++)];
        c.body = data_->neighbors.body[static_cast<std::size_t>(p.body_b - data_->tool.body_count)].id;
        c.link = p.body_a;
        c.state = p.memory.state;
        c.normal = p.normal;
        c.normal_force = p.memory.normal_force;
        c.tangent_force = p.memory.tangent_force;
        c.position.setZero();
        c.penetration = 0.0;
        for (int k = 0; k < p.point_count; ++k) {
            const PatchPoint& point = p.point[static_cast<std::size_t>(k)];
            c.position += point.weight * point.position;
            c.penetration = std::max(c.penetration, -point.gap);
        }
    }
    r.run.max_force = std::max(r.run.max_force, gate.applied.head<2>().norm());
    r.run.max_penetration = std::max(r.run.max_penetration, r.max_penetration);
    r.run.collisions += static_cast<std::uint64_t>(r.colliding);
    if (held_ && gate_.armed()) {
        r.run.error_sum += (r.grip - r.device).head<2>().squaredNorm();
        ++r.run.error_count;
    }
    r.movable_count = data_->movable_count;
    for (int i = 0; i < data_->movable_count; ++i)
        r.movable[static_cast<std::size_t>(i)] = data_->movable[static_cast<std::size_t>(i)].belief;
}

} // namespace haptics
