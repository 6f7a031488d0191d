#include "hid/hid_link.hpp"

#include <fcntl.h>
#include <sched.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <cstring>
#include <numbers>

#include "hid/quiet_thread.hpp"

namespace haptics {

namespace {

// why the system does not open a path, or 0 when it does
int open_errno(const std::string& path) {
    if (path.rfind("/dev/", 0) != 0)
        return 0;
    const int file = ::open(path.c_str(), O_RDWR | O_CLOEXEC);
    if (file < 0)
        return errno;
    ::close(file);
    return 0;
}

std::string cannot_open(const std::string& name, const std::string& path, const HidPantographOptions& options,
                        const std::string& reason) {
    const int code = open_errno(path);
    if (code != EACCES && code != EPERM)
        return "The device " + name + " could not be opened (" + path + ": " + reason +
               "). Unplug it, plug it in again, and close other programs that use it.";
    return "The device " + name + " may not be opened by this user (" + path +
           ": permission denied). Put this line into /etc/udev/rules.d/70-haptics.rules\n  " +
           hid_udev_rule(options.vendor, options.product) +
           "\nthen run, as root, udevadm control --reload-rules, and plug the device in again.";
}

std::string not_found(const std::vector<HidFound>& found, const HidPantographOptions& options) {
    const std::string id = hid_id_text(options.vendor, options.product);
    if (found.empty())
        return "No haptic device " + id +
               " is plugged in. Plug it in, or set vendor_id and product_id to what lsusb shows for it.";
    std::string serials;
    for (const HidFound& f : found)
        serials += (serials.empty() ? "" : ", ") + (f.serial.empty() ? std::string("(none)") : f.serial);
    return "No haptic device " + id + " with the serial \"" + options.serial + "\" is plugged in; there is " +
           serials + ". Set serial to one of these, or leave it empty to take the first.";
}

std::string bad_feature(const std::string& name, const char* what, HidDecode found, std::size_t size,
                        int version) {
    switch (found) {
    case HidDecode::wrong_version:
        return "The device " + name + " speaks version " + std::to_string(version) +
               " of the protocol, this addon version " + std::to_string(HAPTICS_PROTOCOL_VERSION) +
               ". Update the device's firmware or the addon.";
    case HidDecode::wrong_crc:
        return "The " + std::string(what) + " of the device " + name +
               " has a wrong checksum. Use another cable or USB port; should it stay so, flash its firmware "
               "again.";
    case HidDecode::out_of_range:
        return "The " + std::string(what) + " of the device " + name +
               " holds a figure that cannot be. Calibrate it again (docs/hid-protocol.md lists the ranges).";
    case HidDecode::good:
    case HidDecode::wrong_size:
    case HidDecode::wrong_id:
        break;
    }
    return "The device " + name + " gave " + std::to_string(size) + " bytes as its " + what +
           ", which is no answer of this protocol. Set vendor_id and product_id to those of a haptic device, "
           "or "
           "flash its firmware again.";
}

HidAxisMap make_map(const HidCalibration& calibration, std::size_t axes) {
    HidAxisMap map;
    map.axes = axes;
    for (std::size_t i = 0; i < axes; ++i) {
        const HidAxis& a = calibration.axis[i];
        const double gear = a.gear_millionths * 1.0e-6;
        map.counts_per_rad[i] = a.counts_per_turn * gear / (2.0 * std::numbers::pi);
        map.radian[i] = (a.reversed ? -1.0 : 1.0) / map.counts_per_rad[i];
        map.offset[i] = a.offset_urad * 1.0e-6;
        map.micro_torque[i] = 1.0e6 / gear;
        map.limit[i] = a.torque_limit_unm;
    }
    return map;
}

} // namespace

HidLink::HidLink() {
    sem_init(&posted_, 0, 0);
}

std::unique_ptr<HidLink> HidLink::open(const HidPantographOptions& options, std::string& error) {
    std::unique_ptr<HidLink> link(new HidLink);
    link->library_ =
        HidLibrary::load(options.library.empty() ? HidLibrary::usual_names() : options.library, error);
    if (link->library_ == nullptr)
        return nullptr;
    const std::vector<HidFound> found = link->library_->find(static_cast<std::uint16_t>(options.vendor),
                                                             static_cast<std::uint16_t>(options.product));
    const HidFound* chosen = nullptr;
    for (const HidFound& f : found)
        if (chosen == nullptr && (options.serial.empty() || f.serial == options.serial))
            chosen = &f;
    if (chosen == nullptr) {
        error = not_found(found, options);
        return nullptr;
    }
    link->name_ = (chosen->product.empty() ? "" : chosen->product + " ") +
                  hid_id_text(options.vendor, options.product) +
                  (chosen->serial.empty() ? "" : ", serial " + chosen->serial + ",");
    link->path_ = chosen->path;
    if (!link->open_handles(options, error) || !link->question(options, error))
        return nullptr;
    link->thread_ = start_quiet_thread(
        "haptic-writer", [raw = link.get(), priority = options.priority] { raw->write_commands(priority); });
    return link;
}

bool HidLink::open_handles(const HidPantographOptions& options, std::string& error) {
    std::string reason;
    reader_ = library_->open(path_, reason);
    if (reader_ == nullptr) {
        error = cannot_open(name_, path_, options, reason);
        return false;
    }
    writer_ = library_->open(path_, reason);
    if (writer_ == nullptr)
        writer_ = reader_;
    return true;
}

bool HidLink::question(const HidPantographOptions& options, std::string& error) {
    int version = 0;
    std::vector<std::uint8_t> bytes =
        library_->get_feature(reader_, HAPTICS_IDENTITY_ID, HAPTICS_IDENTITY_SIZE);
    HidDecode answer = decode_identity(bytes, identity_, version);
    if (answer != HidDecode::good) {
        error = bad_feature(name_, "identity", answer, bytes.size(), version);
        return false;
    }
    const auto axes = static_cast<std::size_t>(options.geometry.motors());
    if (identity_.motors != axes) {
        error = "The device " + name_ + " has " + std::to_string(identity_.motors) +
                " motors, but the geometry set has " + std::to_string(axes) +
                ". Set geometry to the device's linkage.";
        return false;
    }
    bytes = library_->get_feature(reader_, HAPTICS_CALIBRATION_ID, HAPTICS_CALIBRATION_SIZE);
    answer = decode_calibration(bytes, axes, calibration_);
    if (answer != HidDecode::good) {
        error = bad_feature(name_, "calibration", answer, bytes.size(), bytes.size() > 1 ? bytes[1] : 0);
        return false;
    }
    map_ = make_map(calibration_, axes);
    return true;
}

HidLink::~HidLink() {
    if (thread_.joinable()) {
        ending_.store(true, std::memory_order_release);
        sem_post(&posted_);
        thread_.join();
    }
    if (writer_ != nullptr && writer_ != reader_)
        library_->close(writer_);
    if (reader_ != nullptr)
        library_->close(reader_);
    sem_destroy(&posted_);
}

int HidLink::read(std::span<std::uint8_t> bytes) noexcept {
    const int got = library_->read_timeout(reader_, bytes.data(), bytes.size(), 0);
    if (got < 0)
        broken_.store(true, std::memory_order_relaxed);
    return got;
}

void HidLink::post(const HidCommand& command) noexcept {
    commands_.try_write(command);
    sem_post(&posted_);
}

bool HidLink::write(HidCommand command) noexcept {
    std::array<std::uint8_t, HAPTICS_OUTPUT_SIZE> bytes{};
    command.sequence = ++sequence_;
    encode_command(command, bytes);
    if (library_->write(writer_, bytes.data(), bytes.size()) != static_cast<int>(bytes.size()))
        return false;
    sent_.store(sent_.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
    return true;
}

void HidLink::write_commands(int priority) noexcept {
    if (priority > 0) {
        sched_param parameters{};
        parameters.sched_priority = priority;
        // where it is not permitted the writer goes on without
        sched_setscheduler(0, SCHED_FIFO | SCHED_RESET_ON_FORK, &parameters);
    }
    while (true) {
        while (sem_wait(&posted_) != 0) {
        }
        const auto newest = commands_.try_read();
        if (newest.is_new && !write(newest.value))
            break;
        if (ending_.load(std::memory_order_acquire)) {
            // the last word: motors off; should it get lost, the device's watchdog says it 20 ms later
            write(HidCommand{});
            return;
        }
    }
    broken_.store(true, std::memory_order_relaxed);
}

bool HidLink::act(std::uint8_t action) {
    std::vector<std::uint8_t> request(HAPTICS_ACTION_SIZE);
    encode_action(action, std::span<std::uint8_t, HAPTICS_ACTION_SIZE>(request.data(), HAPTICS_ACTION_SIZE));
    std::string reason;
    hid_device* const own = library_->open(path_, reason);
    hid_device* const used = own != nullptr ? own : reader_;
    library_->send_feature(used, request);
    const std::vector<std::uint8_t> answer =
        library_->get_feature(used, HAPTICS_ACTION_ID, HAPTICS_ACTION_SIZE);
    if (own != nullptr)
        library_->close(own);
    std::uint8_t done = HAPTICS_ACTION_NONE;
    std::uint8_t result = HAPTICS_RESULT_NONE;
    return decode_action(answer, done, result) == HidDecode::good && done == action &&
           result == HAPTICS_RESULT_DONE;
}

} // namespace haptics
