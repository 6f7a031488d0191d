#include "devices/hid/emulated/emulated_device.hpp"

#include <haptics/core/pantograph/inertia.hpp>

#include <poll.h>
#include <pthread.h>
#include <sched.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <time.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <stdexcept>

namespace haptics::testing {

namespace {

namespace fs = std::filesystem;

constexpr std::uint32_t k_tick_us = 1000;
// what the kernel keeps for each open file is 64 reports; a packet of 56 bytes takes 768 in a queue here
constexpr int k_queue_bytes = 64 * 768 / 2;

std::int32_t micro(double value) {
    return static_cast<std::int32_t>(std::lround(value * 1.0e6));
}

SimulatedPantographOptions mechanics_of(const EmulatedDeviceOptions& o) {
    SimulatedPantographOptions m;
    m.geometry = o.geometry;
    m.inertia_model = InertiaModel::linkage;
    m.encoder_model = EncoderModel::exact;
    m.hand = o.hand;
    // the firmware holds to the limits
    m.limit_motors = false;
    return m;
}

int listen_at(const fs::path& path) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    const std::string text = path.string();
    if (text.size() >= sizeof address.sun_path)
        throw std::runtime_error("the path " + text +
                                 " is too long for a socket; set TMPDIR to a shorter one");
    std::memcpy(address.sun_path, text.c_str(), text.size() + 1);
    const int listener = socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    if (listener < 0 || bind(listener, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 ||
        listen(listener, 16) != 0)
        throw std::runtime_error("no socket at " + text);
    return listener;
}

void write_text(const fs::path& path, const std::string& text) {
    std::ofstream(path, std::ios::binary) << text;
}

std::string hex(int value, int digits) {
    char text[16];
    std::snprintf(text, sizeof text, "%0*X", digits, static_cast<unsigned>(value));
    return text;
}

} // namespace

EmulatedDevice::EmulatedDevice(const EmulatedDeviceOptions& options, std::string name)
    : options_(options)
    , mechanics_(mechanics_of(options)) {
    const char* registry = std::getenv("HAPTICS_EMULATED_HID");
    if (registry == nullptr)
        throw std::runtime_error(
            "HAPTICS_EMULATED_HID is not set: start this through tools/testing/hid_test.sh");
    folder_ = (fs::path(registry) / name).string();
    const PantographGeometry& g = options.geometry;
    const auto axes = static_cast<std::uint8_t>(g.motors());
    identity_.kind = axes == 4 ? HAPTICS_KIND_TWIN_FIVE_BAR : HAPTICS_KIND_FIVE_BAR;
    identity_.encoders = axes;
    identity_.motors = axes;
    identity_.capabilities =
        static_cast<std::uint8_t>((options.measures_force ? HAPTICS_CAN_MEASURE_HAND_FORCE : 0U) |
                                  (options.absolute ? HAPTICS_CAN_HOME_ITSELF : 0U));
    identity_.major = 1;
    identity_.interval_us = k_tick_us;
    options.serial.copy(identity_.serial, sizeof identity_.serial);
    JointVector home;
    mechanics_.kinematics().inverse(g.home, home);
    for (std::size_t i = 0; i < axes; ++i) {
        haptics_axis& a = calibration_.axis[i];
        a.offset_urad = micro(home[static_cast<Eigen::Index>(i)]);
        a.counts_per_turn =
            static_cast<std::uint32_t>(std::lround(g.motor.counts_per_revolution / g.gear_ratio[i]));
        a.gear_millionths = static_cast<std::uint32_t>(std::lround(g.gear_ratio[i] * 1.0e6));
        a.torque_constant_unm_per_a = static_cast<std::uint32_t>(micro(g.motor.torque_constant));
        a.torque_limit_unm = static_cast<std::uint32_t>(micro(g.motor.torque_limit));
        // both directions are used
        if (i % 2 == 1)
            calibration_.reversed = static_cast<std::uint8_t>(calibration_.reversed | (1U << i));
    }
    for (int i = 0; i < 3; ++i)
        calibration_.home[i] = micro(g.home[i]);
}

EmulatedDevice::~EmulatedDevice() {
    stop();
    unplug();
}

void EmulatedDevice::write_registry() {
    const fs::path folder(folder_);
    const fs::path making(folder_ + ".making");
    fs::remove_all(making);
    fs::remove_all(folder);
    fs::create_directories(making);
    write_text(making / "uevent", "HID_ID=0003:0000" + hex(options_.vendor, 4) + ":0000" +
                                      hex(options_.product, 4) +
                                      "\nHID_NAME=Emulated pantograph\nHID_UNIQ=" + options_.serial + "\n");
    write_text(making / "manufacturer", "Godot Haptics");
    write_text(making / "product", "Emulated pantograph");
    write_text(making / "bcdDevice", "0100");
    constexpr std::uint8_t k_descriptor[HAPTICS_REPORT_DESCRIPTOR_SIZE] = HAPTICS_REPORT_DESCRIPTOR;
    write_text(making / "report_descriptor",
               std::string(reinterpret_cast<const char*>(k_descriptor), sizeof k_descriptor));
    reports_socket_ = listen_at(making / "reports");
    features_socket_ = listen_at(making / "features");
    // there at once and whole
    fs::rename(making, folder);
}

void EmulatedDevice::plug() {
    if (serving_)
        return;
    {
        const std::lock_guard lock(mutex_);
        haptics_firmware_init(&firmware_, &identity_, &calibration_, clock_us_);
        count_at_power_on_.fill(0);
        haptics_sample sample{};
        measure(sample);
        if (!options_.absolute)
            std::copy_n(sample.count, HAPTICS_AXES, count_at_power_on_.begin());
        has_command_ = false;
        answered_ = 0;
        torque_.fill(0);
    }
    write_registry();
    serving_ = true;
    server_ = std::thread([this] { serve(); });
}

void EmulatedDevice::unplug() {
    if (!serving_)
        return;
    fs::rename(folder_, folder_ + ".gone");
    fs::remove_all(folder_ + ".gone");
    serving_ = false;
    commanded_.notify_all();
    server_.join();
    const std::lock_guard lock(mutex_);
    for (const File& file : files_)
        close(file.connection);
    files_.clear();
    close(reports_socket_);
    close(features_socket_);
}

void EmulatedDevice::deny(bool denied) {
    if (denied)
        write_text(fs::path(folder_) / "denied", "");
    else
        fs::remove(fs::path(folder_) / "denied");
}

void EmulatedDevice::set_way(std::function<std::vector<Bytes>(const Bytes&)> way) {
    const std::lock_guard lock(mutex_);
    way_ = std::move(way);
}
void EmulatedDevice::set_board(std::function<void(haptics_sample&)> board) {
    const std::lock_guard lock(mutex_);
    board_ = std::move(board);
}
void EmulatedDevice::set_features(std::function<void(Bytes&)> features) {
    const std::lock_guard lock(mutex_);
    features_ = std::move(features);
}

// ---- the wire ----

void EmulatedDevice::serve() {
    std::vector<pollfd> waiting;
    while (serving_) {
        waiting.assign({{reports_socket_, POLLIN, 0}, {features_socket_, POLLIN, 0}});
        {
            const std::lock_guard lock(mutex_);
            for (const File& file : files_)
                waiting.push_back({file.connection, static_cast<short>(deaf_ ? 0 : POLLIN), 0});
        }
        if (poll(waiting.data(), waiting.size(), 5) <= 0)
            continue;
        if (waiting[0].revents != 0)
            accept_file();
        if (waiting[1].revents != 0)
            answer_feature();
        const std::lock_guard lock(mutex_);
        for (std::size_t i = 2; i < waiting.size(); ++i) {
            File& file = files_[i - 2];
            if (waiting[i].revents == 0 || (take_command(file) && (waiting[i].revents & POLLHUP) == 0))
                continue;
            close(file.connection);
            file.connection = -1;
        }
        std::erase_if(files_, [](const File& file) { return file.connection < 0; });
    }
}

void EmulatedDevice::accept_file() {
    const int connection = accept4(reports_socket_, nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK);
    if (connection < 0)
        return;
    setsockopt(connection, SOL_SOCKET, SO_SNDBUF, &k_queue_bytes, sizeof k_queue_bytes);
    const std::lock_guard lock(mutex_);
    files_.push_back({connection, false, 0});
}

void EmulatedDevice::answer_feature() {
    const int connection = accept4(features_socket_, nullptr, nullptr, SOCK_CLOEXEC);
    if (connection < 0)
        return;
    std::array<std::uint8_t, 1024> request{};
    const ssize_t got = recv(connection, request.data(), request.size(), 0);
    const std::lock_guard lock(mutex_);
    if (got == 4 && request[0] == 'G') {
        const std::size_t capacity = request[2] + 256U * request[3];
        Bytes report(512);
        report.resize(haptics_firmware_get_feature(&firmware_, request[1], report.data(), report.size()));
        if (features_ && !report.empty())
            features_(report);
        send(connection, report.data(), std::min(report.size(), capacity), MSG_NOSIGNAL);
    } else if (got > 1 && request[0] == 'S') {
        haptics_firmware_set_feature(&firmware_, request.data() + 1, static_cast<std::size_t>(got - 1),
                                     clock_us_);
        const std::uint8_t done = 0;
        send(connection, &done, 1, MSG_NOSIGNAL);
    }
    close(connection);
}

// false when the host closed the file
bool EmulatedDevice::take_command(File& file) {
    std::array<std::uint8_t, 256> bytes{};
    for (;;) {
        const ssize_t got = recv(file.connection, bytes.data(), bytes.size(), MSG_DONTWAIT);
        // closed with reports unread: the socket says so once, before what was sent to the end
        if (got < 0 && errno == ECONNRESET)
            continue;
        if (got < 0)
            return errno == EAGAIN;
        if (got == 0)
            return false;
        file.writes = true;
        const auto size = static_cast<std::size_t>(got);
        if (haptics_firmware_command(&firmware_, bytes.data(), size, clock_us_) != HAPTICS_TAKEN) {
            ++books_.refused;
            continue;
        }
        books_.command_gaps += has_command_ ? firmware_.command_sequence - last_command_ - 1U : 0U;
        has_command_ = true;
        last_command_ = firmware_.command_sequence;
        std::uint32_t input = 0;
        for (unsigned i = 0; i < 4; ++i)
            input |= static_cast<std::uint32_t>(bytes[HAPTICS_OUTPUT_AT_INPUT + i]) << (8U * i);
        answered_ = input;
        ++books_.commands;
        commanded_.notify_all();
    }
}

void EmulatedDevice::send_report() {
    Bytes report(HAPTICS_INPUT_SIZE);
    haptics_firmware_input(&firmware_, clock_us_, report.data());
    ++books_.reports;
    std::vector<Bytes> packets{report};
    if (way_)
        packets = way_(report);
    for (File& file : files_)
        for (const Bytes& packet : packets)
            if (send(file.connection, packet.data(), packet.size(), MSG_DONTWAIT | MSG_NOSIGNAL) < 0 &&
                errno == EAGAIN)
                ++file.dropped;
}

// ---- motors and encoders ----

void EmulatedDevice::measure(haptics_sample& sample) {
    const PantographGeometry& g = options_.geometry;
    JointVector angles;
    mechanics_.kinematics().inverse(mechanics_.true_pose(), angles);
    for (std::size_t i = 0; i < static_cast<std::size_t>(g.motors()); ++i) {
        const haptics_axis& a = calibration_.axis[i];
        const double turns = std::remainder(angles[static_cast<Eigen::Index>(i)] - a.offset_urad * 1.0e-6,
                                            2.0 * std::numbers::pi) /
                             (2.0 * std::numbers::pi);
        const double counts = turns * a.counts_per_turn * (a.gear_millionths * 1.0e-6);
        const bool reversed = ((calibration_.reversed >> i) & 1U) != 0U;
        sample.count[i] =
            static_cast<std::int32_t>(std::lround(reversed ? -counts : counts)) - count_at_power_on_[i];
    }
    for (int i = 0; i < 3; ++i)
        sample.hand_force[i] = micro(mechanics_.hand_force()[i]);
    sample.force_valid = options_.measures_force;
    sample.absolute = options_.absolute;
}

void EmulatedDevice::apply_motors() {
    std::array<std::int32_t, HAPTICS_AXES> torque{};
    books_.enabled_ticks += haptics_firmware_torques(&firmware_, clock_us_, torque.data()) ? 1U : 0U;
    torque_ = torque;
    const PantographState state = mechanics_.kinematics().locate(mechanics_.true_pose());
    JointVector joint = JointVector::Zero();
    for (std::size_t i = 0; i < HAPTICS_AXES; ++i)
        joint[static_cast<Eigen::Index>(i)] =
            torque[i] * 1.0e-6 * (calibration_.axis[i].gear_millionths * 1.0e-6);
    mechanics_.write(state.rates.transpose() * joint);
}

void EmulatedDevice::tick_locked() {
    apply_motors();
    mechanics_.advance(k_tick_us * 1.0e-6);
    clock_us_ += k_tick_us;
    haptics_sample sample{};
    measure(sample);
    if (board_)
        board_(sample);
    haptics_firmware_sample(&firmware_, &sample, clock_us_);
    send_report();
}

void EmulatedDevice::tick() {
    const std::lock_guard lock(mutex_);
    tick_locked();
    hand_clock_ns_ += std::int64_t{1000} * k_tick_us;
}

void EmulatedDevice::run(Pace pace) {
    ticking_ = true;
    ticker_ = std::thread([this, pace] {
        // as punctual as the loop that it serves, where that is permitted
        sched_param parameters{};
        parameters.sched_priority = 70;
        pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters);
        timespec next{};
        clock_gettime(CLOCK_MONOTONIC, &next);
        while (ticking_) {
            next.tv_nsec += 1000 * static_cast<long>(k_tick_us);
            if (next.tv_nsec >= 1000000000) {
                next.tv_nsec -= 1000000000;
                ++next.tv_sec;
            }
            clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &next, nullptr);
            std::unique_lock lock(mutex_);
            const auto host_is_near = [this] {
                return !ticking_ || firmware_.input_sequence - answered_ < k_ahead || !has_command_;
            };
            if (pace == Pace::with_host && !host_is_near()) {
                ++books_.held_up;
                commanded_.wait(lock, host_is_near);
                clock_gettime(CLOCK_MONOTONIC, &next);
            }
            if (ticking_)
                tick_locked();
        }
    });
}

void EmulatedDevice::stop() {
    ticking_ = false;
    commanded_.notify_all();
    if (ticker_.joinable())
        ticker_.join();
}

bool EmulatedDevice::wait_for_commands(std::uint64_t count) {
    std::unique_lock lock(mutex_);
    return commanded_.wait_for(lock, std::chrono::seconds(10), [&] { return books_.commands >= count; });
}

EmulatedDevice::Books EmulatedDevice::books() {
    const std::lock_guard lock(mutex_);
    Books books = books_;
    for (const File& file : files_)
        if (!file.writes)
            books.dropped += file.dropped;
    return books;
}

std::array<std::int32_t, HAPTICS_AXES> EmulatedDevice::torques() {
    const std::lock_guard lock(mutex_);
    return torque_;
}

} // namespace haptics::testing
