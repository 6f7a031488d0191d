// The owner's and the supervisor's side: connections are opened and closed here, never in the loop.
//
// A link is the supervisor's until it is offered; the loop takes the offer, uses the link, and hands it back
// when it is broken. Only then is it closed, so that the loop never holds a closed one.

#include <haptics/devices/hid/hid_pantograph.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "hid/hid_link.hpp"
#include "hid/quiet_thread.hpp"

namespace haptics {

namespace {

constexpr auto k_look = std::chrono::milliseconds(20);
// a look for the device goes through all devices of the system
constexpr int k_looks_a_try = 10;
constexpr auto k_home_patience = std::chrono::seconds(1);

// the geometry with what the device says about itself
PantographGeometry calibrated(PantographGeometry geometry, const HidCalibration& calibration) {
    double least = 50.0;
    double counts = 1.0e9;
    const auto motors = static_cast<std::size_t>(geometry.motors());
    for (std::size_t i = 0; i < motors; ++i) {
        const HidAxis& a = calibration.axis[i];
        geometry.gear_ratio[i] = a.gear_millionths * 1.0e-6;
        geometry.encoder_offset[i] = a.offset_urad * 1.0e-6;
        geometry.encoder_direction[i] = a.reversed ? -1 : 1;
        least = std::min(least, a.torque_limit_unm * 1.0e-6);
        counts = std::min(counts, a.counts_per_turn * geometry.gear_ratio[i]);
    }
    geometry.motor.torque_constant = calibration.axis[0].torque_constant_unm_per_a * 1.0e-6;
    geometry.motor.torque_limit = least;
    geometry.motor.counts_per_revolution = counts;
    geometry.home =
        Pose(calibration.home[0] * 1.0e-6, calibration.home[1] * 1.0e-6, calibration.home[2] * 1.0e-6);
    return geometry;
}

// the offsets are the joint angles at home, so they and the linkage have to give the home pose
std::string compare_home(const PantographGeometry& geometry, const std::string& name) {
    const PantographKinematics kinematics(geometry);
    JointVector angles = JointVector::Zero();
    for (int i = 0; i < geometry.motors(); ++i)
        angles[i] = geometry.encoder_offset[static_cast<std::size_t>(i)];
    const PoseEstimate found = kinematics.forward(angles);
    const double apart = (found.pose - geometry.home).head<2>().norm();
    const double turned = std::abs(found.pose.z() - geometry.home.z());
    constexpr double k_apart = 1.0e-3;
    constexpr double k_turned = 0.02;
    if (found.valid && apart <= k_apart && turned <= k_turned)
        return {};
    const std::string way = found.valid ? "are " + std::to_string(apart * 1.0e3) + " mm and " +
                                              std::to_string(turned) + " rad apart"
                                        : std::string("do not fit the linkage at all");
    return "The device " + name +
           " and the geometry set contradict one another: the device's home pose and the "
           "pose that its offsets give " +
           way +
           " (1 mm and 0.02 rad are allowed). Set geometry to the device's linkage, or calibrate the device "
           "again.";
}

bool same_calibration(const HidCalibration& a, const HidCalibration& b) {
    for (std::size_t i = 0; i < k_hid_axes; ++i) {
        const HidAxis& x = a.axis[i];
        const HidAxis& y = b.axis[i];
        if (x.offset_urad != y.offset_urad || x.counts_per_turn != y.counts_per_turn ||
            x.gear_millionths != y.gear_millionths || x.torque_limit_unm != y.torque_limit_unm ||
            x.reversed != y.reversed)
            return false;
    }
    return a.home == b.home;
}

} // namespace

std::unique_ptr<HidPantograph> HidPantograph::open(const HidPantographOptions& options, std::string& error) {
    const std::vector<FigureError> errors = validate(options);
    if (!errors.empty()) {
        error = errors.front().message();
        return nullptr;
    }
    std::unique_ptr<HidLink> link = HidLink::open(options, error);
    if (link == nullptr)
        return nullptr;
    const PantographGeometry geometry = calibrated(options.geometry, link->calibration());
    const std::vector<FigureError> wrong = validate(geometry);
    if (!wrong.empty())
        error = "The calibration of the device " + link->name() +
                " does not fit the geometry set: " + wrong.front().message();
    else
        error = compare_home(geometry, link->name());
    if (!error.empty())
        return nullptr;
    return std::unique_ptr<HidPantograph>(new HidPantograph(options, geometry, std::move(link)));
}

HidPantograph::HidPantograph(const HidPantographOptions& options, const PantographGeometry& geometry,
                             std::unique_ptr<HidLink> link)
    : options_(options)
    , kinematics_(geometry)
    , identity_(link->identity())
    , calibration_(link->calibration())
    , name_(link->name())
    , stream_(options.stream)
    , state_(kinematics_.locate(geometry.home))
    , current_(std::move(link)) {
    reading_.pose = geometry.home;
    reading_.homed = false;
    offered_.store(current_.get(), std::memory_order_release);
    thread_ = start_quiet_thread("haptic-device", [this] { supervise(); });
}

HidPantograph::~HidPantograph() {
    {
        const std::lock_guard lock(mutex_);
        ending_ = true;
    }
    wake_.notify_all();
    thread_.join();
    // the loop has ended, so nobody holds the link; its destructor lets the motors go
    current_.reset();
}

void HidPantograph::supervise() {
    std::unique_lock lock(mutex_);
    for (int look = 1; !ending_; ++look) {
        wake_.wait_for(lock, k_look);
        if (handed_back_.exchange(nullptr, std::memory_order_acquire) != nullptr)
            close_lost_link(lock);
        if (current_ == nullptr && look % k_looks_a_try == 0 && !ending_)
            try_again(lock);
        if (home_ == Home::asked)
            answer_home();
    }
    home_ = Home::away;
    answered_.notify_all();
}

void HidPantograph::close_lost_link(std::unique_lock<std::mutex>& lock) {
    messages_.push_back("The device " + name_ +
                        " does not answer any more: it was unplugged, or hangs. Plug it in "
                        "again; it then needs homing and arming.");
    last_problem_.clear();
    sent_before_ += current_->sent();
    overtaken_before_ += current_->overtaken();
    std::unique_ptr<HidLink> lost = std::move(current_);
    // closing may wait for the system
    lock.unlock();
    lost.reset();
    lock.lock();
}

void HidPantograph::try_again(std::unique_lock<std::mutex>& lock) {
    lock.unlock();
    std::string problem;
    std::unique_ptr<HidLink> link = HidLink::open(options_, problem);
    if (link != nullptr && link->identity().serial != identity_.serial)
        problem = "Another device than before is plugged in: " + link->name() + " instead of " + name_ +
                  ". Plug the first one in, or start the world again to use this one.";
    else if (link != nullptr && !same_calibration(link->calibration(), calibration_))
        problem =
            "The device " + name_ + " came back with another calibration. Start the world again to use it.";
    if (!problem.empty())
        link.reset();
    lock.lock();
    if (link == nullptr) {
        // absence was told already
        if (problem != last_problem_ && problem.rfind("No haptic device", 0) != 0)
            messages_.push_back(problem);
        last_problem_ = problem;
        return;
    }
    messages_.push_back("The device " + name_ +
                        " is back. Put its handle into the home pose, home it, and arm.");
    current_ = std::move(link);
    connections_.store(connections_.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
    connected_.store(true, std::memory_order_relaxed);
    offered_.store(current_.get(), std::memory_order_release);
}

void HidPantograph::answer_home() {
    home_ = current_ == nullptr                       ? Home::away
            : current_->act(HAPTICS_ACTION_HOME_HERE) ? Home::done
                                                      : Home::refused;
    answered_.notify_all();
}

std::string HidPantograph::home_here() {
    std::unique_lock lock(mutex_);
    home_ = Home::asked;
    wake_.notify_all();
    answered_.wait_for(lock, k_home_patience, [this] { return home_ != Home::asked; });
    const Home answer = home_;
    home_ = Home::idle;
    switch (answer) {
    case Home::done:
        return {};
    case Home::refused:
        return "The device " + name_ +
               " refused to be homed. Take the force off, hold the handle still in the home pose, and ask "
               "again; a device "
               "that finds its zero by itself needs no homing.";
    case Home::away:
        return "The device " + name_ + " cannot be homed: it is not plugged in. Plug it in, then ask again.";
    case Home::idle:
    case Home::asked:
        break;
    }
    return "The device " + name_ +
           " did not answer within a second. Unplug it, plug it in again, and ask again.";
}

std::vector<std::string> HidPantograph::take_messages() {
    const std::lock_guard lock(mutex_);
    return std::exchange(messages_, {});
}

std::uint64_t HidPantograph::commands_sent() const {
    const std::lock_guard lock(mutex_);
    return sent_before_ + (current_ != nullptr ? current_->sent() : 0);
}

std::uint64_t HidPantograph::commands_overtaken() const {
    const std::lock_guard lock(mutex_);
    return overtaken_before_ + (current_ != nullptr ? current_->overtaken() : 0);
}

} // namespace haptics
