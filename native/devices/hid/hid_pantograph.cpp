// The loop's side: what a haptic step does.
//
// Reading drains everything that waits and uses the newest good report. Counts become joint angles by the
// device's calibration, the angles a handle pose by least squares over all encoders (native/core/pantograph).
// The report's age, that is how much longer than the quickest one it took or waited, and the time since the
// report before go along: the session moves the handle on by velocity times age, so that a loop faster than
// USB, or one whose steps slide past the USB frames, does not see the handle in stairs.
//
// A device that let its motors go wants to be told so before it drives them again: one command without
// enable, sent as soon as its status shows it. The fault that comes with that status keeps the output shut
// until somebody arms it.
//
// While the device does not know its zero its counts mean nothing: the reading then is the home pose, at
// rest, which is also where the handle is the moment it is homed.

#include <haptics/core/pantograph/inertia.hpp>
#include <haptics/core/pantograph/torque_map.hpp>
#include <haptics/devices/hid/hid_pantograph.hpp>
#include <haptics/realtime/loop_clock.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "hid/hid_link.hpp"

namespace haptics {

namespace {

// reports that one step takes in at most: twice what the kernel keeps
constexpr int k_most_reports = 128;
// the device stays enabled over so long a time of zero torque: drivers are not switched at every zero (ns)
constexpr std::int64_t k_stay_enabled_ns = 100'000'000;
// a device that was told to enable does so within this time (ns)
constexpr std::int64_t k_enabled_by_now_ns = 100'000'000;

std::int32_t rounded_within(double value, double limit) {
    return static_cast<std::int32_t>(std::lround(std::clamp(value, -limit, limit)));
}

} // namespace

bool HidPantograph::take_link() {
    if (link_ != nullptr)
        return true;
    link_ = offered_.exchange(nullptr, std::memory_order_acquire);
    if (link_ == nullptr)
        return false;
    const bool absolute = (link_->identity().capabilities & HAPTICS_CAN_HOME_ITSELF) != 0;
    stream_.begin(link_->map().axes, link_->map().counts_per_rad, absolute);
    reading_.homed = false;
    was_let_go_ = true;
    enabled_until_ns_ = 0;
    enabled_since_ns_ = 0;
    release_ = true;
    heard_ns_ = now_ns_;
    return true;
}

void HidPantograph::hand_back() {
    connected_.store(false, std::memory_order_relaxed);
    handed_back_.store(link_, std::memory_order_release);
    link_ = nullptr;
}

bool HidPantograph::drain(std::int64_t now_ns) {
    // a byte of room, so that a report that is too long shows
    std::array<std::uint8_t, HAPTICS_INPUT_SIZE + 8> bytes;
    for (int i = 0; i < k_most_reports; ++i) {
        const int got = link_->read(bytes);
        if (got < 0)
            return false;
        if (got == 0)
            break;
        stream_.take(std::span<const std::uint8_t>(bytes).first(static_cast<std::size_t>(got)), now_ns);
    }
    return !link_->is_broken();
}

// false when the counts belong to no pose
bool HidPantograph::place(const HidSample& sample) {
    const bool homed = (sample.status & HAPTICS_STATUS_HOMED) != 0 && !stream_.lost_its_place();
    reading_.has_angles = homed;
    if (!homed) {
        reading_.homed = false;
        reading_.pose = kinematics_.geometry().home;
        state_ = kinematics_.locate(reading_.pose);
        return true;
    }
    const HidAxisMap& map = link_->map();
    JointVector angles = JointVector::Zero();
    for (std::size_t i = 0; i < map.axes; ++i)
        angles[static_cast<Eigen::Index>(i)] = map.offset[i] + map.radian[i] * sample.count[i];
    const PoseEstimate estimate = kinematics_.forward(angles);
    if (!estimate.valid) {
        reading_.faults = reading_.faults | Fault::check_the_encoders;
        return false;
    }
    if (estimate.residual > options_.residual_limit)
        reading_.faults = reading_.faults | Fault::home_the_device_again;
    reading_.homed = true;
    reading_.pose = estimate.pose;
    reading_.angles = angles;
    reading_.homings = sample.homings;
    state_ = kinematics_.locate(reading_.pose);
    return true;
}

void HidPantograph::judge_status(const HidSample& sample) {
    const auto is = [&sample](std::uint16_t bit) { return (sample.status & bit) != 0; };
    Fault found = Fault::none;
    if (is(HAPTICS_STATUS_STOPPED))
        found = found | Fault::release_the_stop;
    if (is(HAPTICS_STATUS_DRIVER_FAULT) || is(HAPTICS_STATUS_HOT))
        found = found | Fault::let_the_device_recover;
    if (is(HAPTICS_STATUS_ENCODER_FAULT))
        found = found | Fault::check_the_encoder_wiring;
    // it was held up before: at the start, nobody had commanded yet
    if (is(HAPTICS_STATUS_WATCHDOG) && !was_let_go_)
        found = found | Fault::give_the_loop_more_time;
    was_let_go_ = is(HAPTICS_STATUS_WATCHDOG);
    // asked for long enough, and not given, for a reason that was over before anybody saw it
    const bool asked = enabled_since_ns_ != 0 && now_ns_ - enabled_since_ns_ > k_enabled_by_now_ns;
    const bool refused = asked && !is(HAPTICS_STATUS_ENABLED);
    if (refused && found == Fault::none)
        found = found | Fault::let_the_device_recover;
    release_ = release_ || refused || was_let_go_;
    reading_.faults = reading_.faults | found;
}

bool HidPantograph::read(DeviceReading& reading) {
    now_ns_ = options_.clock != nullptr ? options_.clock() : loop_clock_ns();
    if (!take_link())
        return false;
    if (!drain(now_ns_)) {
        hand_back();
        return false;
    }
    reading_.faults = Fault::none;
    HidSample sample;
    const std::uint64_t jumps = stream_.counts().jumped;
    if (stream_.newest(now_ns_, sample)) {
        sample_ = sample;
        heard_ns_ = now_ns_;
        judge_status(sample);
        if (place(sample)) {
            ++reading_.sequence;
            reading_.interval = stream_.interval();
            reading_.age = stream_.age();
            reading_.buttons = sample.buttons;
            reading_.has_hand_force = (sample.status & HAPTICS_STATUS_HAND_FORCE) != 0;
            for (std::size_t i = 0; i < 3; ++i)
                reading_.hand_force[static_cast<Eigen::Index>(i)] =
                    reading_.has_hand_force ? sample.hand_force[i] * 1.0e-6 : 0.0;
        } else {
            stream_.note_no_pose();
        }
    } else if (stream_.counts().jumped != jumps) {
        reading_.faults = reading_.faults | Fault::check_the_encoder_wiring;
        reading_.homed = false;
    } else if (static_cast<double>(now_ns_ - heard_ns_) * 1.0e-9 > options_.silence) {
        hand_back();
        return false;
    }
    publish_counts();
    if (reading_.sequence == 0)
        return false;
    reading = reading_;
    return true;
}

void HidPantograph::publish_counts() {
    const HidCounts& c = stream_.counts();
    const std::array<std::uint64_t, 11> all{c.accepted,      c.superseded, c.wrong_size,   c.corrupt,
                                            c.wrong_version, c.repeated,   c.out_of_order, c.late,
                                            c.jumped,        c.no_pose,    c.lost};
    for (std::size_t i = 0; i < all.size(); ++i)
        published_[i].store(all[i], std::memory_order_relaxed);
}

void HidPantograph::write(const Wrench& force) {
    if (link_ == nullptr)
        return;
    HidCommand command;
    command.input = sample_.sequence;
    bool drives = false;
    if (reading_.homed) {
        const HidAxisMap& map = link_->map();
        const JointVector torque = joint_torques(kinematics_, state_, force).torque;
        for (std::size_t i = 0; i < map.axes; ++i) {
            command.torque[i] =
                rounded_within(torque[static_cast<Eigen::Index>(i)] * map.micro_torque[i], map.limit[i]);
            drives = drives || command.torque[i] != 0;
        }
    }
    if (drives)
        enabled_until_ns_ = now_ns_ + k_stay_enabled_ns;
    command.enable = reading_.homed && now_ns_ < enabled_until_ns_ && !release_;
    release_ = false;
    if (!command.enable) {
        command.torque.fill(0);
        enabled_since_ns_ = 0;
    } else if (enabled_since_ns_ == 0) {
        enabled_since_ns_ = now_ns_;
    }
    link_->post(command);
}

Mat3 HidPantograph::handle_mass(const Pose& pose) const {
    return handle_mass_matrix(kinematics_, kinematics_.locate(pose));
}

Vec3 HidPantograph::reading_error() const {
    // half a count at the motor axis, seen at the end of a stretched arm
    const PantographGeometry& g = kinematics_.geometry();
    const double half = std::numbers::pi / g.motor.counts_per_revolution;
    const double reach = g.bar[0].proximal_length[0] + g.bar[0].distal_length[0];
    const double lever = (g.attachment[0] - g.attachment[1]).norm();
    return {half * reach, half * reach, lever > 0.0 ? 2.0 * half * reach / lever : half};
}

double HidPantograph::interval() const {
    return identity_.interval_us * 1.0e-6;
}

HidCounts HidPantograph::published_counts() const {
    const auto at = [this](std::size_t i) { return published_[i].load(std::memory_order_relaxed); };
    return {at(0), at(1), at(2), at(3), at(4), at(5), at(6), at(7), at(8), at(9), at(10)};
}

} // namespace haptics
