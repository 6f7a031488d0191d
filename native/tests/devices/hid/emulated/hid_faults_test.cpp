// Everything that can go wrong between the driver and an open device, on the real hidapi.
#include <doctest/doctest.h>

#include <support/realtime_guard.hpp>

#include "devices/hid/emulated/hid_rig.hpp"

using namespace haptics;
using namespace haptics::testing;

namespace {

using Bytes = EmulatedDevice::Bytes;
using Packets = std::vector<Bytes>;

// a change of one report on its way, once
void once(EmulatedDevice& device, std::function<std::vector<Bytes>(const Bytes&)> change) {
    device.set_way([change, done = false](const Bytes& report) mutable {
        if (done)
            return Packets{report};
        done = true;
        return change(report);
    });
}

} // namespace

TEST_SUITE("reports on their way") {
    TEST_CASE("short, long, damaged, repeated and old ones are counted and do not disturb the reading") {
        HidRig rig;
        REQUIRE_MESSAGE(rig.port != nullptr, rig.error);
        const HidCounts before = rig.port->counts();
        const auto bad = [&](std::function<std::vector<Bytes>(const Bytes&)> change) {
            once(rig.device, std::move(change));
            const DeviceReading last = rig.reading;
            rig.step();
            CHECK(rig.reading.pose == last.pose);
            CHECK(rig.reading.faults == Fault::none);
            CHECK(rig.step());
        };
        bad([](const Bytes& r) { return Packets{Bytes(r.begin(), r.begin() + 20)}; });
        bad([](const Bytes& r) {
            Bytes longer = r;
            longer.resize(60);
            return Packets{longer};
        });
        CHECK(rig.port->counts().wrong_size == before.wrong_size + 2);
        bad([](const Bytes& r) {
            Bytes damaged = r;
            damaged[13] ^= 0x40U;
            return Packets{damaged};
        });
        CHECK(rig.port->counts().corrupt == before.corrupt + 1);
        bad([](const Bytes& /*r*/) { return Packets{}; });
        // the numbers of the four above never came
        CHECK(rig.port->counts().lost == before.lost + 4);
        once(rig.device, [](const Bytes& r) { return Packets{r, r}; });
        CHECK(rig.step());
        CHECK(rig.port->counts().repeated == before.repeated + 1);
        // one that comes after its successor
        auto held = std::make_shared<std::vector<Bytes>>();
        rig.device.set_way([held](const Bytes& r) {
            held->push_back(r);
            return held->size() == 2 ? Packets{(*held)[1], (*held)[0]} : Packets{};
        });
        rig.device.tick();
        CHECK(rig.step());
        CHECK(rig.port->counts().out_of_order == before.out_of_order + 1);
        rig.device.set_way({});
        CHECK(rig.step());
    }

    TEST_CASE("a late report is left out") {
        HidPantographOptions options;
        options.silence = 10.0;
        HidRig rig(EmulatedDeviceOptions{}, options);
        REQUIRE_MESSAGE(rig.port != nullptr, rig.error);
        // steps of real time here, so that lateness is real
        rig.device.run(Pace::real_time);
        CHECK(eventually([&] { return rig.port->read(rig.reading) && rig.port->counts().accepted > 300; }));
        const std::uint64_t late = rig.port->counts().late;
        auto queue = std::make_shared<std::vector<Bytes>>();
        rig.device.set_way([queue](const Bytes& r) {
            // each report comes 50 ms after its time
            queue->push_back(r);
            if (queue->size() < 50)
                return Packets{};
            Bytes oldest = queue->front();
            queue->erase(queue->begin());
            return Packets{oldest};
        });
        CHECK(eventually([&] { return rig.port->read(rig.reading) && rig.port->counts().late > late + 20; }));
        rig.device.stop();
    }

    TEST_CASE("any bytes at all disturb nothing: a thousand reports of noise between good ones") {
        HidRig rig;
        REQUIRE_MESSAGE(rig.port != nullptr, rig.error);
        std::uint64_t state = 9;
        rig.device.set_way([&state](const Bytes& r) {
            std::vector<Bytes> packets;
            for (int n = 0; n < 3; ++n) {
                state = state * 6364136223846793005ULL + 1442695040888963407ULL;
                Bytes noise(1 + (state >> 33U) % 64);
                for (std::uint8_t& byte : noise) {
                    state = state * 6364136223846793005ULL + 1442695040888963407ULL;
                    byte = static_cast<std::uint8_t>(state >> 56U);
                }
                packets.push_back(noise);
            }
            packets.push_back(r);
            return packets;
        });
        int fresh = 0;
        for (int n = 0; n < 400; ++n) {
            fresh += rig.step() ? 1 : 0;
            CHECK(rig.reading.pose.allFinite());
            CHECK(rig.reading.faults == Fault::none);
            rig.command(Wrench::Zero());
        }
        CHECK(fresh == 400);
        CHECK(rig.port->counts().wrong_size + rig.port->counts().corrupt == 1200);
        CHECK(rig.port->counts().lost == 0);
    }
}

TEST_SUITE("what the device measures") {
    TEST_CASE("an encoder that jumps faults, and the device has to be homed again") {
        HidRig rig;
        REQUIRE_MESSAGE(rig.port != nullptr, rig.error);
        const Pose last = rig.reading.pose;
        rig.device.set_board([](haptics_sample& s) { s.count[1] += 40000; });
        CHECK_FALSE(rig.step());
        CHECK(has(rig.reading.faults, Fault::check_the_encoder_wiring));
        CHECK_FALSE(rig.reading.homed);
        CHECK(rig.reading.pose == last);
        CHECK(rig.port->counts().jumped == 1);
        rig.cycle(Wrench(1.0, 0.0, 0.0), 5);
        CHECK(rig.device.torques() == std::array<std::int32_t, 4>{});
        CHECK_FALSE(rig.reading.homed);
        // these encoders are absolute: a tenth of a second without a jump, and they are believed again
        rig.device.set_board({});
        rig.step();
        rig.cycle(Wrench::Zero(), 110);
        CHECK(rig.reading.homed);
        CHECK((rig.reading.pose - rig.device.mechanics().true_pose()).norm() < 2e-5);
    }

    TEST_CASE("a stuck encoder of a twin contradicts the others") {
        HidRig rig;
        REQUIRE_MESSAGE(rig.port != nullptr, rig.error);
        const std::int32_t stuck = [&] {
            std::int32_t count = 0;
            rig.device.set_board([&count](haptics_sample& s) { count = s.count[0]; });
            rig.step();
            return count;
        }();
        rig.device.set_board([stuck](haptics_sample& s) { s.count[0] = stuck; });
        // the hand moves on: 1 mm a step to the side
        double moved = 0.0;
        for (int n = 1; n <= 60 && rig.reading.faults == Fault::none; ++n) {
            moved = 0.5e-3 * n;
            rig.device.mechanics().place(Pose(moved, 0.5 * moved, 0.0));
            rig.step();
        }
        CHECK(rig.reading.faults == Fault::home_the_device_again);
        // 0.005 rad of contradiction, at an arm of 0.14 m, in a direction that this encoder sees only half of
        CHECK(moved < 0.01);
    }

    TEST_CASE("the device's own complaints become faults") {
        HidRig rig;
        REQUIRE_MESSAGE(rig.port != nullptr, rig.error);
        const auto fault_of = [&](bool haptics_sample::* bit) {
            rig.device.set_board([bit](haptics_sample& s) { s.*bit = true; });
            rig.step();
            return rig.reading.faults;
        };
        CHECK(fault_of(&haptics_sample::stop_pressed) == Fault::release_the_stop);
        CHECK(fault_of(&haptics_sample::hot) == Fault::let_the_device_recover);
        CHECK(fault_of(&haptics_sample::encoder_fault) == Fault::check_the_encoder_wiring);
        CHECK(fault_of(&haptics_sample::driver_fault) == Fault::let_the_device_recover);
    }

    TEST_CASE("hand force and buttons come through") {
        EmulatedDeviceOptions options;
        options.hand = pushing_hand(Wrench(0.25, -0.5, 0.002));
        HidRig rig(options);
        REQUIRE_MESSAGE(rig.port != nullptr, rig.error);
        rig.device.set_board([](haptics_sample& s) { s.buttons = 0x80000005; });
        rig.step();
        CHECK(rig.reading.has_hand_force);
        CHECK((rig.reading.hand_force - Wrench(0.25, -0.5, 0.002)).norm() < 2e-6);
        CHECK(rig.reading.buttons == 0x80000005);
    }
}

TEST_SUITE("the watch on both sides") {
    TEST_CASE("the device lets its motors go 20 ms after the last command, and the host learns of it") {
        HidRig rig;
        REQUIRE_MESSAGE(rig.port != nullptr, rig.error);
        rig.cycle(Wrench(1.0, 0.0, 0.0), 5);
        CHECK(rig.device.torques() != std::array<std::int32_t, 4>{});
        // the host stalls: no command, no look
        for (int ms = 0; ms < 20; ++ms)
            rig.device.tick();
        CHECK(rig.device.torques() != std::array<std::int32_t, 4>{});
        rig.device.tick();
        rig.device.tick();
        CHECK(rig.device.torques() == std::array<std::int32_t, 4>{});
        rig.step();
        CHECK(rig.reading.faults == Fault::give_the_loop_more_time);
        // the fault is told once, and the device is told that the host knows: what comes next is the gate's
        // business
        rig.command(Wrench::Zero());
        rig.step();
        CHECK(rig.reading.faults == Fault::none);
        CHECK((rig.device.firmware().watchdog) == false);
        rig.cycle(Wrench(1.0, 0.0, 0.0), 2);
        rig.device.tick();
        CHECK(rig.device.torques() != std::array<std::int32_t, 4>{});
    }

    TEST_CASE("a stalled loop faults the session, and force needs an explicit arm") {
        EmulatedDeviceOptions options;
        options.hand = pushing_hand(Wrench::Zero());
        HidRig rig(options);
        REQUIRE_MESSAGE(rig.port != nullptr, rig.error);
        auto session = session_on(*rig.port, 1000.0, 0.02);
        const auto run = [&](int steps) {
            for (int n = 0; n < steps; ++n) {
                rig.device.tick();
                const std::uint64_t before = rig.device.books().commands;
                session->step();
                rig.device.wait_for_commands(before + 1);
            }
        };
        run(300);
        REQUIRE(session->report().armed);
        // the handle has to be pushed for a force to be there
        rig.device.mechanics().hand().set_force(Wrench(1.0, 0.0, 0.0));
        run(150);
        REQUIRE(rig.device.books().enabled_ticks > 10);
        // the loop stalls for 25 ms
        for (int ms = 0; ms < 25; ++ms)
            rig.device.tick();
        run(300);
        CHECK_FALSE(session->report().armed);
        CHECK(session->report().faults == Fault::give_the_loop_more_time);
        CHECK(rig.device.torques() == std::array<std::int32_t, 4>{});
        rig.device.mechanics().hand().set_force(Wrench::Zero());
        const Pose far = rig.device.mechanics().true_pose();
        for (int k = 1; k <= 400; ++k) {
            rig.device.mechanics().place(far * (1.0 - k / 400.0));
            run(1);
        }
        run(100);
        session->arm();
        run(300);
        CHECK(session->report().armed);
        CHECK(session->report().faults == Fault::none);
    }

    TEST_CASE("a device that hangs while it takes commands holds up the writer, not the loop") {
        HidRig rig;
        REQUIRE_MESSAGE(rig.port != nullptr, rig.error);
        rig.cycle(Wrench(1.0, 0.0, 0.0), 5);
        rig.device.set_deaf(true);
        // far more than the queue holds: the writer is stuck in the system by now, and this loop goes on
        int fresh = 0;
        int steps = 0;
        while (steps < 3000 || (rig.port->commands_overtaken() < 100 && steps < 100000)) {
            fresh += rig.step() ? 1 : 0;
            rig.port->write(Wrench(0.0, 1.0, 0.0));
            ++steps;
        }
        CHECK(fresh == steps);
        CHECK(rig.port->commands_overtaken() >= 100);
        rig.device.set_deaf(false);
        CHECK(eventually([&] { return rig.device.books().commands == rig.port->commands_sent(); }));
        // what arrives then is the newest command
        CHECK(rig.device.books().command_gaps == 0);
    }

    TEST_CASE("closing lets the motors go") {
        HidRig rig;
        REQUIRE_MESSAGE(rig.port != nullptr, rig.error);
        rig.cycle(Wrench(1.0, 0.0, 0.0), 3);
        rig.device.tick();
        CHECK(rig.device.torques() != std::array<std::int32_t, 4>{});
        const std::uint64_t commands = rig.device.books().commands;
        rig.port.reset();
        CHECK(rig.device.wait_for_commands(commands + 1));
        rig.device.tick();
        CHECK(rig.device.torques() == std::array<std::int32_t, 4>{});
    }

    TEST_CASE("reading and writing take no memory, no lock, no file but the device's" *
              doctest::skip(!RealtimeGuard::traps())) {
        HidRig rig;
        REQUIRE_MESSAGE(rig.port != nullptr, rig.error);
        RealtimeGuard guard;
        for (int n = 0; n < 500; ++n) {
            rig.device.tick();
            guard.begin();
            rig.port->read(rig.reading);
            rig.port->write(Wrench(0.5, 0.0, 0.0));
            guard.end();
        }
        CHECK(guard.count(Violation::allocation) == 0);
        CHECK(guard.count(Violation::lock) == 0);
        CHECK(guard.count(Violation::print) == 0);
        CHECK(guard.count(Violation::thread) == 0);
        // poll and read of hidapi, and nothing else; hidapi gives an empty error text back each time
        CHECK(guard.count(Violation::sleep) == guard.count(Violation::file) + 500);
    }
}
