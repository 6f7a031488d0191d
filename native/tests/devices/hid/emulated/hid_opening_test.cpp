// How a device is found and opened, how it goes and comes back, and what is said where it cannot be had, on
// the real hidapi.
#include <doctest/doctest.h>

#include <cmath>
#include <fstream>
#include <sstream>

#include "devices/hid/emulated/hid_rig.hpp"

using namespace haptics;
using namespace haptics::testing;

namespace {

using Bytes = EmulatedDevice::Bytes;

// opens with these options and gives the message
std::string refusal(const HidPantographOptions& options) {
    std::string error;
    const auto port = HidPantograph::open(options, error);
    CHECK(port == nullptr);
    return error;
}

bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

} // namespace

TEST_SUITE("opening") {
    TEST_CASE("a device is found, questioned, read and commanded") {
        HidRig rig;
        REQUIRE_MESSAGE(rig.port != nullptr, rig.error);
        CHECK(rig.port->name() == "Emulated pantograph 1209:0001, serial E-001,");
        CHECK(std::string(rig.port->identity().serial.data()) == "E-001");
        CHECK(rig.port->freedoms() == 3);
        CHECK(rig.reading.homed);
        // half a count of 262144 at 0.32 m is 3.8 um
        CHECK((rig.reading.pose - rig.device.mechanics().true_pose()).norm() < 2e-5);
        rig.cycle(Wrench(1.0, -0.5, 0.01), 3);
        CHECK(rig.device.books().refused == 0);
        // the motors give the wrench that was asked for
        rig.device.tick();
        CHECK((rig.device.mechanics().motor_force() - Wrench(1.0, -0.5, 0.01)).norm() < 1e-4);
    }

    TEST_CASE("poses all over the workspace come back to within the encoders' steps") {
        for (const bool twin : {true, false}) {
            CAPTURE(twin);
            EmulatedDeviceOptions options;
            options.geometry = twin ? ubc_twin_pantograph() : haply_2diy_v3();
            HidRig rig(options);
            REQUIRE_MESSAGE(rig.port != nullptr, rig.error);
            const Vec3 allowed = 4.0 * rig.port->reading_error();
            int looked = 0;
            for (double x = -0.04; x <= 0.041; x += 0.02)
                for (double y = -0.03; y <= 0.031; y += 0.02) {
                    const Pose pose(x, y, twin ? 5.0 * x : 0.0);
                    // in small steps: a handle that jumps is a fault
                    const Pose from = rig.device.mechanics().true_pose();
                    for (int k = 1; k <= 20; ++k) {
                        if (!rig.device.mechanics().place(from + (pose - from) * (k / 20.0)))
                            continue;
                        rig.step();
                    }
                    const Vec3 error = rig.reading.pose - rig.device.mechanics().true_pose();
                    CHECK(std::abs(error.x()) < allowed.x());
                    CHECK(std::abs(error.y()) < allowed.y());
                    CHECK(std::abs(error.z()) < allowed.z());
                    CHECK(rig.reading.faults == Fault::none);
                    ++looked;
                }
            CHECK(looked == 20);
        }
    }

    TEST_CASE("without hidapi the message names what is missing and how to get it") {
        EmulatedDevice device{EmulatedDeviceOptions{}};
        device.plug();
        HidPantographOptions options;
        options.library = {"libhidapi-nowhere.so.0", "/nonexistent/libhidapi.so"};
        const std::string error = refusal(options);
        CHECK(contains(error, "hidapi, which talks to the device, could not be loaded"));
        CHECK(contains(error, "libhidapi-nowhere.so.0, /nonexistent/libhidapi.so"));
        CHECK(contains(error, "apt install libhidapi-hidraw0"));
        // a library that is another one
        options.library = {"libm.so.6"};
        CHECK(contains(refusal(options), "libm.so.6 is no hidapi"));
    }

    TEST_CASE("no device, or one with another serial") {
        CHECK(
            contains(refusal({}), "No haptic device 1209:0001 is plugged in. Plug it in, or set vendor_id"));
        EmulatedDevice device{EmulatedDeviceOptions{}};
        device.plug();
        HidPantographOptions options;
        options.serial = "E-999";
        const std::string error = refusal(options);
        CHECK(contains(error, "with the serial \"E-999\" is plugged in; there is E-001."));
        options.serial = "E-001";
        std::string problem;
        CHECK_MESSAGE(HidPantograph::open(options, problem) != nullptr, problem);
    }

    TEST_CASE("of two devices the serial chooses") {
        EmulatedDeviceOptions second;
        second.serial = "E-002";
        EmulatedDevice a{EmulatedDeviceOptions{}};
        EmulatedDevice b{second, "hidraw9001"};
        a.plug();
        b.plug();
        HidPantographOptions options;
        options.serial = "E-002";
        std::string error;
        const auto port = HidPantograph::open(options, error);
        REQUIRE_MESSAGE(port != nullptr, error);
        CHECK(std::string(port->identity().serial.data()) == "E-002");
    }

    TEST_CASE("without permission the message holds the very rule that the addon ships") {
        EmulatedDevice device{EmulatedDeviceOptions{}};
        device.plug();
        device.deny(true);
        const std::string error = refusal({});
        const std::string rule = "KERNEL==\"hidraw*\", SUBSYSTEM==\"hidraw\", ATTRS{idVendor}==\"1209\", "
                                 "ATTRS{idProduct}==\"0001\", "
                                 "TAG+=\"uaccess\"";
        CHECK(contains(error, "may not be opened by this user"));
        CHECK(contains(error, "/etc/udev/rules.d/70-haptics.rules\n  " + rule + "\n"));
        CHECK(contains(error, "udevadm control --reload-rules"));
        std::ifstream file("addons/haptics/70-haptics.rules");
        std::stringstream shipped;
        shipped << file.rdbuf();
        CHECK(contains(shipped.str(), "\n" + rule + "\n"));
        device.deny(false);
        std::string problem;
        CHECK_MESSAGE(HidPantograph::open({}, problem) != nullptr, problem);
    }

    TEST_CASE("a device of another protocol, a damaged answer, a foreign device, a wrong geometry") {
        EmulatedDevice device{EmulatedDeviceOptions{}};
        device.plug();
        const auto reseal = [](Bytes& report) {
            const std::uint32_t crc = haptics_firmware_crc32(report.data(), report.size() - 4);
            for (std::size_t i = 0; i < 4; ++i)
                report[report.size() - 4 + i] = static_cast<std::uint8_t>(crc >> (8 * i));
        };
        device.set_features([&](Bytes& report) {
            report[1] = 2;
            reseal(report);
        });
        CHECK(contains(refusal({}), "speaks version 2 of the protocol, this addon version 1. Update"));
        device.set_features([](Bytes& report) {
            if (report[0] == HAPTICS_CALIBRATION_ID)
                report[30] ^= 1U;
        });
        CHECK(contains(refusal({}), "calibration of the device Emulated pantograph"));
        CHECK(contains(refusal({}), "has a wrong checksum. Use another cable"));
        device.set_features([&](Bytes& report) {
            if (report[0] == HAPTICS_CALIBRATION_ID) {
                // no counts at all
                std::fill_n(report.begin() + HAPTICS_CALIBRATION_AT_AXIS + HAPTICS_AXIS_AT_COUNTS, 4,
                            std::uint8_t{0});
                reseal(report);
            }
        });
        CHECK(contains(refusal({}), "holds a figure that cannot be"));
        device.set_features([](Bytes& report) { report.resize(4); });
        CHECK(contains(refusal({}), "gave 4 bytes as its identity, which is no answer of this protocol"));
        device.set_features({});
        HidPantographOptions options;
        options.geometry = haply_2diy_v3();
        CHECK(contains(refusal(options), "has 4 motors, but the geometry set has 2. Set geometry"));
        options.geometry = ubc_twin_pantograph();
        options.geometry.bar[0].proximal_length = {0.12, 0.12};
        CHECK(contains(refusal(options), "contradict one another"));
    }

    TEST_CASE("options out of range are named") {
        HidPantographOptions options;
        options.vendor = 0;
        CHECK(contains(refusal(options), "vendor_id is 0"));
        options = {};
        options.residual_limit = std::nan("");
        CHECK(contains(refusal(options), "encoder_tolerance is nan"));
    }
}

TEST_SUITE("unplug and replug") {
    TEST_CASE("the device goes and comes back while the loop runs; it needs homing and an explicit arm") {
        EmulatedDeviceOptions options;
        options.absolute = false;
        EmulatedDevice device{options};
        device.plug();
        std::string error;
        const auto port = HidPantograph::open(options_for(options), error);
        REQUIRE_MESSAGE(port != nullptr, error);
        auto session = session_on(*port, 1000.0, 0.02);
        std::uint64_t commands = 0;
        // a millisecond of loop and device
        const auto step = [&] {
            device.tick();
            session->step();
            if (port->is_connected()) {
                device.wait_for_commands(commands + 1);
                commands = device.books().commands;
            }
        };
        const auto run_until = [&](auto condition) {
            for (int n = 0; n < 20000; ++n) {
                step();
                if (condition())
                    return true;
                if (!port->is_connected())
                    wait_ms(1);
            }
            return false;
        };
        const auto& report = session->report();
        // relative encoders: nothing before homing
        for (int n = 0; n < 300; ++n)
            step();
        CHECK_FALSE(report.armed);
        CHECK(session->arm_result() == ArmResult::home_the_device_first);
        CHECK(port->home_here().empty());
        CHECK(run_until([&] { return report.armed; }));

        for (int round = 0; round < 3; ++round) {
            CAPTURE(round);
            device.unplug();
            CHECK(run_until([&] { return has(report.faults, Fault::reconnect_the_device); }));
            CHECK_FALSE(report.armed);
            CHECK_FALSE(port->is_connected());
            CHECK(contains(port->home_here(), "it is not plugged in"));
            CHECK(eventually([&] {
                session->step();
                const auto messages = port->take_messages();
                return !messages.empty() && contains(messages.front(), "does not answer any more");
            }));
            // somebody moved the handle meanwhile; relative encoders do not know
            device.mechanics().place(Pose(0.01, 0.0, 0.0));
            device.plug();
            CHECK(run_until([&] { return port->is_connected(); }));
            CHECK(port->connections() == static_cast<std::uint64_t>(round) + 2);
            commands = device.books().commands;
            for (int n = 0; n < 200; ++n)
                step();
            const auto messages = port->take_messages();
            REQUIRE(messages.size() == 1);
            CHECK(
                contains(messages.front(), "is back. Put its handle into the home pose, home it, and arm."));
            CHECK_FALSE(report.armed);
            // armed too early: refused, not remembered
            session->arm();
            for (int n = 0; n < 100; ++n)
                step();
            CHECK(session->arm_result() == ArmResult::home_the_device_first);
            device.mechanics().place(Pose::Zero());
            for (int n = 0; n < 300; ++n)
                step();
            CHECK(port->home_here().empty());
            for (int n = 0; n < 300; ++n)
                step();
            CHECK_FALSE(report.armed);
            session->arm();
            CHECK(run_until([&] { return report.armed; }));
            CHECK(report.faults == Fault::none);
        }
    }

    TEST_CASE("another device in its place is refused") {
        EmulatedDevice first{EmulatedDeviceOptions{}};
        first.plug();
        std::string error;
        const auto port = HidPantograph::open({}, error);
        REQUIRE_MESSAGE(port != nullptr, error);
        DeviceReading reading;
        first.unplug();
        EmulatedDeviceOptions other;
        other.serial = "E-777";
        EmulatedDevice second{other};
        second.plug();
        std::string said;
        CHECK(eventually([&] {
            port->read(reading);
            for (const std::string& text : port->take_messages())
                said += text;
            return contains(said, "Another device than before is plugged in");
        }));
        CHECK_FALSE(port->is_connected());
    }

    TEST_CASE("a device that falls silent is given up and opened anew") {
        HidPantographOptions options;
        options.silence = 0.1;
        EmulatedDevice device{EmulatedDeviceOptions{}};
        device.plug();
        std::string error;
        const auto port = HidPantograph::open(options, error);
        REQUIRE_MESSAGE(port != nullptr, error);
        DeviceReading reading;
        device.tick();
        CHECK(eventually([&] {
            port->read(reading);
            return port->connections() > 1;
        }));
    }

    TEST_CASE("permission lost while unplugged is told with the rule") {
        EmulatedDevice device{EmulatedDeviceOptions{}};
        device.plug();
        std::string error;
        const auto port = HidPantograph::open({}, error);
        REQUIRE_MESSAGE(port != nullptr, error);
        device.unplug();
        DeviceReading reading;
        CHECK(eventually([&] { return !port->read(reading); }));
        device.plug();
        device.deny(true);
        std::string said;
        CHECK(eventually([&] {
            for (const std::string& text : port->take_messages())
                said += text;
            return contains(said, "70-haptics.rules");
        }));
        device.deny(false);
        CHECK(eventually([&] { return port->is_connected(); }));
    }
}
