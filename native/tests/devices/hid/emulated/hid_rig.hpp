#pragma once
/// The driver on an emulated device: step by step, the test playing the loop, or on a real loop thread.

#include <haptics/core/control/session.hpp>
#include <haptics/devices/hid/hid_pantograph.hpp>
#include <haptics/shared/paper_wall.hpp>

#include <chrono>
#include <memory>
#include <string>
#include <thread>

#include "devices/hid/emulated/emulated_device.hpp"

namespace haptics::testing {

inline void wait_ms(int ms) {
    std::this_thread::sleep_for(std::chrono::milliseconds(ms));
}

/// Waits until something holds; false after 10 s, which only a broken driver takes.
template <class Condition>
bool eventually(Condition condition) {
    for (int n = 0; n < 10000; ++n) {
        if (condition())
            return true;
        wait_ms(1);
    }
    return false;
}

/// Options that fit an emulated device of these, for a host that is stepped by hand along with it.
inline HidPantographOptions options_for(const EmulatedDeviceOptions& device) {
    HidPantographOptions o;
    o.vendor = device.vendor;
    o.product = device.product;
    o.geometry = device.geometry;
    o.clock = &EmulatedDevice::hand_clock_ns;
    return o;
}

/// A plugged-in device and its driver; the test ticks the one and steps the other.
struct HidRig {
    explicit HidRig(const EmulatedDeviceOptions& device_options = {})
        : HidRig(device_options, options_for(device_options)) {}
    HidRig(const EmulatedDeviceOptions& device_options, const HidPantographOptions& options)
        : device(device_options) {
        device.plug();
        port = HidPantograph::open(options, error);
        if (port == nullptr)
            return;
        // the system has to have told the device of the open files
        eventually([this] { return step(); });
        command(Wrench::Zero());
    }
    /// A report and its reading; true when the reading is new.
    bool step() {
        const std::uint64_t last = reading.sequence;
        device.tick();
        return port->read(reading) && reading.sequence != last;
    }
    /// A command, and waits until the device took it.
    void command(const Wrench& force) {
        const std::uint64_t before = device.books().commands;
        port->write(force);
        device.wait_for_commands(before + 1);
    }
    /// A report, its reading, a command.
    void cycle(const Wrench& force, int times = 1) {
        for (int n = 0; n < times; ++n) {
            step();
            command(force);
        }
    }

    EmulatedDevice device;
    std::string error;
    std::unique_ptr<HidPantograph> port;
    DeviceReading reading;
};

/// A session on the paper's floor, 20 mm below the tool.
inline std::unique_ptr<Session> session_on(HidPantograph& port, double rate, double patience) {
    SessionSettings s;
    s.step = 1.0 / rate;
    s.reading_error = port.reading_error();
    s.device_delay = port.interval();
    s.sample_period = port.interval();
    s.device_patience = patience;
    OutputGate gate(SafetyLimits{}, port.kinematics());
    auto session = std::make_unique<Session>(s, shared::box_tool(), gate, port, Pose(0.0, 0.03, 0.0));
    session->take(*shared::floor_of(1));
    return session;
}

} // namespace haptics::testing
