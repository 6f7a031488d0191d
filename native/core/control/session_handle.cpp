// The handle as a session sees it: readings, its motion between them, the grasp, clutch and mapping.

#include <haptics/core/control/session.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace haptics {
namespace {

// beyond any device, m and m/s, N
constexpr double k_beyond_device = 1e4;

template <class Vector>
bool is_below(const Vector& v, double most) {
    return (v.cwiseAbs().array() < most).all(); // false for what is not a number
}

bool is_true_reading(const DeviceReading& r) {
    return is_below(r.pose, k_beyond_device) && (!r.has_velocity || is_below(r.velocity, k_beyond_device));
}

Fault without(Fault set, Fault bits) {
    return static_cast<Fault>(static_cast<std::uint32_t>(set) & ~static_cast<std::uint32_t>(bits));
}

// a handle is moved on by its velocity for so long, s; beyond that the velocity says too little
constexpr double k_most_ahead = 0.003;
// least share of the gate with which force channels begin
constexpr double k_faint = 0.05;

} // namespace

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
        grasp_.set(0.0);
        freeze_offset();
    }
    hand_force_.setZero();
    if (reading_.has_hand_force && is_below(reading_.hand_force, k_beyond_device))
        hand_force_ = settings_.mapping.wrench_to_scene(reading_.hand_force);
    else if (observer_)
        hand_force_ = settings_.mapping.wrench_to_scene(observer_->hand_force());
}

// The hand carries what the gate lets through, the tool is to feel the whole.
Wrench Session::whole_hand_force() const {
    return hand_force_ / std::max(gate_fade_, k_faint);
}

// where the gate leaves little of a force there is too little to tell the hand's part from
double Session::channels() const {
    const double u = std::clamp((gate_fade_ - k_faint) / k_faint, 0.0, 1.0);
    return channels_.share() * u * u * (3.0 - 2.0 * u);
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
    return reading_.faults | care_.fault() | (silent ? Fault::reconnect_the_device : Fault::none) |
           (output_.diverged ? Fault::make_the_scene_milder : Fault::none);
}

void Session::hold(bool held) {
    held_ = held;
    regrab_ = false;
    impulses_.drop();
    if (held && grasp_.share() == 0.0)
        take_hold();
}

void Session::take_hold() {
    freeze_offset();
    grasp_.set(1.0);
    channels_.set(0.0);
    // nobody feels anything before the gate is armed
    taking_ = gate_.armed() ? 2 : 0;
    firmness_ = taking_ > 0 ? 0.0 : 1.0;
}

void Session::freeze_offset() {
    grab_offset_ = grip_pose(data_->grip, data_->pose) - handle_ - turned();
    parked_ = false;
}

void Session::grasp() {
    const double h = settings_.step;
    const double force = output_.full_coupling.head<2>().norm();
    grasp_.advance(held_, 0.0, h);
    channels_.advance(held_, hand_force_.head<2>().norm() + force, h);
    if (regrab_ && grasp_.share() == 0.0) {
        haptics::grab(*model_, *data_, next_grip_);
        mobility_ = grip_mobility(*model_, *data_);
        hold(true);
    } else if (held_ && grasp_.share() == 0.0) {
        take_hold();
    } else if (firmness_ < 1.0) {
        grow_firm();
    }
    last_grip_ = grip_pose(data_->grip, data_->pose);
}

// Taking hold of what moves past the hand at v. A spring frozen at once would be stretched by what it cannot
// stop, and throw the tool back. So a damper alone catches it, b = g B, with g growing by e in a time T. The
// tool's momentum p goes as p' = -b p / m, and the force F = b v as F' = F (1/T - b/m): with x = b T / m that
// is F' = p_0/T^2 x (1 - x) exp(-x), at most 0.31 p_0 / T^2, at x = 2.6. T is chosen so that it is
// Fade::k_largest_step a step, and g begins where B v is half of that. Once g is 1 the tool moves with the
// hand, and the spring begins without tension.
void Session::grow_firm() {
    constexpr double k_steepest = 0.31 / 0.7; // steps are no flow
    constexpr double k_arm = 0.03;            // m, of torques
    constexpr double k_slow = 1e-4;           // m/s
    const double h = settings_.step;
    if (taking_ > 1) {
        --taking_;
    } else if (taking_ == 1) {
        taking_ = 0;
        const Pose grip = grip_pose(data_->grip, data_->pose);
        Twist past = -(grip - last_grip_) / h;
        if (!parked_)
            past += handle_velocity_;
        past.z() += placement_.turn().rate();
        const Wrench momentum = combined_mass(mobility_, device_mass_) * past;
        const double p = std::max(momentum.head<2>().norm(), std::abs(momentum.z()) / k_arm);
        firming_time_ = std::max(5.0 * h, std::sqrt(k_steepest * p * h / Fade::k_largest_step));
        const double force = std::max(gains_.damping.head<2>().maxCoeff() * past.head<2>().norm(),
                                      gains_.damping.z() * std::abs(past.z()) / k_arm);
        const double least = gains_.damping.head<2>().maxCoeff() * k_slow;
        firmness_ = std::min(1.0, 0.5 * Fade::k_largest_step / std::max({force, least, 1e-12}));
    } else {
        firmness_ = std::min(1.0, firmness_ * std::exp(h / firming_time_));
    }
    freeze_offset();
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

} // namespace haptics
