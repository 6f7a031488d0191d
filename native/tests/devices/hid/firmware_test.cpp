// The device's side: what drives a motor, and what stops it.
#include <doctest/doctest.h>

#include <limits>
#include <support/random.hpp>

#include "devices/hid/firmware_fixture.hpp"

using namespace haptics;
using namespace haptics::testing;

namespace {

// driving with 1000 uN m
FirmwareFixture driving(std::uint32_t start_us = 0) {
    FirmwareFixture f(true, start_us);
    f.send(false, 0);
    f.send(true, 1000);
    return f;
}

constexpr std::int32_t k_limit = 600000; // of axis 0

// a small processor has room for it
static_assert(sizeof(haptics_firmware) < 512);

} // namespace

TEST_CASE("motors are let go when no valid command came for 20 ms, and not before") {
    // near the end of the clock's range too
    for (const std::uint32_t start : {0U, 0xFFFFD000U}) {
        FirmwareFixture f = driving(start);
        const std::uint32_t commanded = f.now;
        for (int ms = 1; ms <= 20; ++ms) {
            f.now = commanded + static_cast<std::uint32_t>(1000 * ms);
            CHECK(f.torque() == 1000);
        }
        CHECK((f.report().status & HAPTICS_STATUS_WATCHDOG) == 0);
        f.now = commanded + 20001;
        CHECK(f.torque() == 0);
        CHECK_FALSE(f.driven);
        CHECK((f.report().status & HAPTICS_STATUS_WATCHDOG) != 0);
        CHECK((f.report().status & HAPTICS_STATUS_ENABLED) == 0);
    }
}

TEST_CASE("after that force comes back only when the host let go and asked again") {
    FirmwareFixture f = driving();
    f.now += 30000;
    CHECK(f.torque() == 0);
    for (int n = 0; n < 100; ++n) {
        f.now += 1000;
        CHECK(f.send(true, 1000) == HAPTICS_TAKEN);
        CHECK(f.torque() == 0);
    }
    f.send(false, 0);
    CHECK((f.report().status & HAPTICS_STATUS_WATCHDOG) == 0);
    CHECK(f.torque() == 0);
    f.send(true, 1000);
    CHECK(f.torque() == 1000);
}

TEST_CASE("a wrong command changes nothing and does not keep the watchdog quiet") {
    using Bytes = std::array<std::uint8_t, HAPTICS_OUTPUT_SIZE>;
    struct Wrong {
        const char* what;
        haptics_verdict verdict;
        Bytes (*make)(const FirmwareFixture&);
    };
    const Wrong all[] = {
        {"a damaged one", HAPTICS_WRONG_CRC,
         [](const FirmwareFixture& f) {
             Bytes b = FirmwareFixture::bytes_of(true, 5000, f.sequence + 1);
             b[9] ^= 0x10U;
             return b;
         }},
        {"a wrong checksum", HAPTICS_WRONG_CRC,
         [](const FirmwareFixture& f) {
             Bytes b = FirmwareFixture::bytes_of(true, 5000, f.sequence + 1);
             b[HAPTICS_OUTPUT_AT_CRC] ^= 0x01U;
             return b;
         }},
        {"a repeated one", HAPTICS_OLD_SEQUENCE,
         [](const FirmwareFixture& f) { return FirmwareFixture::bytes_of(true, 5000, f.sequence); }},
        {"one out of order", HAPTICS_OLD_SEQUENCE,
         [](const FirmwareFixture& f) { return FirmwareFixture::bytes_of(true, 5000, f.sequence - 1); }},
        {"one of another version", HAPTICS_WRONG_VERSION,
         [](const FirmwareFixture& f) {
             Bytes b = FirmwareFixture::bytes_of(true, 5000, f.sequence + 1);
             b[HAPTICS_OUTPUT_AT_VERSION] = 2;
             const std::uint32_t crc = hid_crc32(std::span(b).first(HAPTICS_OUTPUT_AT_CRC));
             for (std::size_t i = 0; i < 4; ++i)
                 b[HAPTICS_OUTPUT_AT_CRC + i] = static_cast<std::uint8_t>(crc >> (8 * i));
             return b;
         }},
        {"one of another id", HAPTICS_WRONG_ID,
         [](const FirmwareFixture& f) {
             Bytes b = FirmwareFixture::bytes_of(true, 5000, f.sequence + 1);
             b[0] = HAPTICS_INPUT_ID;
             return b;
         }},
    };
    for (const Wrong& wrong : all) {
        CAPTURE(wrong.what);
        FirmwareFixture f = driving();
        for (int ms = 0; ms < 20; ++ms) {
            f.now += 1000;
            CHECK(f.send_bytes(wrong.make(f)) == wrong.verdict);
            CHECK(f.torque() == 1000);
        }
        CHECK(f.report().refused == 20);
        f.now += 1000;
        CHECK(f.torque() == 0);
    }
    FirmwareFixture f = driving();
    const Bytes whole = FirmwareFixture::bytes_of(true, 5000, f.sequence + 1);
    CHECK(f.send_bytes(std::span(whole).first(31)) == HAPTICS_WRONG_SIZE);
    CHECK(f.send_bytes(std::span(whole).first(0)) == HAPTICS_WRONG_SIZE);
    CHECK(f.torque() == 1000);
}

TEST_CASE("a host that starts anew is heard, whatever number it starts with") {
    FirmwareFixture f = driving();
    f.sequence = 5; // far behind is out of order while the old one is heard
    f.fw.command_sequence = 1000;
    CHECK(f.send(false, 0) == HAPTICS_OLD_SEQUENCE);
    f.now += 30000;
    CHECK(f.send(false, 0) == HAPTICS_TAKEN);
    // and sequence numbers may wrap
    f.sequence = 0xFFFFFFFE;
    f.fw.command_sequence = 0xFFFFFFFE;
    for (int n = 0; n < 4; ++n)
        CHECK(f.send(true, 7) == HAPTICS_TAKEN);
    CHECK(f.torque() == 7);
}

TEST_CASE("torques are cut to each axis' limit") {
    FirmwareFixture f = driving();
    for (const std::int32_t asked : {k_limit + 1, k_limit + 5, std::numeric_limits<std::int32_t>::max()}) {
        f.send(true, asked);
        CHECK(f.torque() == k_limit);
        CHECK((f.report().status & HAPTICS_STATUS_CLAMPED) != 0);
    }
    for (const std::int32_t asked : {-k_limit - 1, std::numeric_limits<std::int32_t>::min()}) {
        f.send(true, asked);
        CHECK(f.torque() == -k_limit);
    }
    f.send(true, -k_limit);
    CHECK(f.torque() == -k_limit);
    CHECK((f.report().status & HAPTICS_STATUS_CLAMPED) == 0);
    // axes that the device does not have
    f.fw.identity.motors = 2;
    f.send(true, 1000);
    CHECK(f.torque() == 1000);
    CHECK(f.torques[2] == 0);
}

TEST_CASE("stop, heat, a driver and an encoder take the force off, and it does not come back by itself") {
    struct Cause {
        bool haptics_sample::* bit;
        std::uint16_t status;
    };
    for (const Cause cause : {Cause{&haptics_sample::stop_pressed, HAPTICS_STATUS_STOPPED},
                              Cause{&haptics_sample::hot, HAPTICS_STATUS_HOT},
                              Cause{&haptics_sample::driver_fault, HAPTICS_STATUS_DRIVER_FAULT},
                              Cause{&haptics_sample::encoder_fault, HAPTICS_STATUS_ENCODER_FAULT}}) {
        CAPTURE(cause.status);
        FirmwareFixture f = driving();
        f.board.*cause.bit = true;
        f.measure();
        CHECK(f.torque() == 0);
        CHECK((f.report().status & cause.status) != 0);
        f.send(true, 1000);
        CHECK(f.torque() == 0);
        f.board.*cause.bit = false;
        f.measure();
        if (cause.status == HAPTICS_STATUS_DRIVER_FAULT) {
            // latched until it is told to forget
            f.send(false, 0);
            f.send(true, 1000);
            CHECK(f.torque() == 0);
            CHECK(f.act(HAPTICS_ACTION_CLEAR_FAULTS) == HAPTICS_TAKEN);
        }
        f.send(true, 1000);
        CHECK(f.torque() == 0);
        f.send(false, 0);
        f.send(true, 1000);
        CHECK(f.torque() == 1000);
    }
}

TEST_CASE("no force before homing, and homing only at rest with the motors off") {
    FirmwareFixture f(false);
    f.board.count[0] = 1000;
    f.measure();
    f.send(false, 0);
    f.send(true, 1000);
    CHECK(f.torque() == 0);
    CHECK((f.report().status & HAPTICS_STATUS_HOMED) == 0);
    // moving
    for (int ms = 0; ms < 300; ++ms) {
        f.now += 1000;
        f.board.count[0] += 300;
        f.measure();
    }
    CHECK(f.act(HAPTICS_ACTION_HOME_HERE) == HAPTICS_REFUSED);
    // quivering by a count is rest
    for (int ms = 0; ms < 110; ++ms) {
        f.now += 1000;
        f.board.count[0] += ms % 2 == 0 ? 1 : -1;
        f.measure();
    }
    CHECK(f.act(HAPTICS_ACTION_HOME_HERE) == HAPTICS_TAKEN);
    HidSample s = f.report();
    CHECK((s.status & HAPTICS_STATUS_HOMED) != 0);
    CHECK(s.count[0] == 0);
    CHECK(s.homings == 1);
    f.board.count[0] += 42;
    f.measure();
    CHECK(f.report().count[0] == 42);
    f.send(false, 0);
    f.send(true, 1000);
    CHECK(f.torque() == 1000);
    CHECK(f.act(HAPTICS_ACTION_HOME_HERE) == HAPTICS_REFUSED);
    CHECK(f.torque() == 1000);
    CHECK(f.act(99) == HAPTICS_REFUSED);
}

TEST_CASE("whatever the host sends, torques stay within limits and follow only what was allowed") {
    Random random(5);
    FirmwareFixture f(true);
    int wrong = 0;
    std::uint64_t driven = 0;
    for (int n = 0; n < 1000000; ++n) {
        f.now += static_cast<std::uint32_t>(random.below(3) == 0 ? random.below(30000) : random.below(2000));
        auto bytes = FirmwareFixture::bytes_of(
            random.below(8) != 0, static_cast<std::int32_t>(random.bits()),
            random.below(16) == 0 ? static_cast<std::uint32_t>(random.bits()) : ++f.sequence);
        if (random.below(8) == 0)
            bytes[static_cast<std::size_t>(random.below(32))] ^=
                static_cast<std::uint8_t>(1 + random.below(255));
        f.send_bytes(bytes);
        if (random.below(64) == 0) {
            f.board.stop_pressed = random.below(4) == 0;
            f.board.hot = random.below(4) == 0;
            f.measure();
        }
        f.torque();
        for (std::size_t i = 0; i < HAPTICS_AXES; ++i) {
            const auto limit = static_cast<std::int32_t>(f.fw.calibration.axis[i].torque_limit_unm);
            wrong += f.torques[i] > limit || f.torques[i] < -limit || (!f.driven && f.torques[i] != 0);
        }
        wrong += f.driven && (f.board.stop_pressed || f.board.hot || f.fw.watchdog);
        driven += f.driven ? 1 : 0;
    }
    CHECK(wrong == 0);
    CHECK(driven > 1000); // otherwise nothing was tested
}

TEST_CASE("current follows torque over the constant, without overflow") {
    FirmwareFixture f;
    CHECK(haptics_firmware_current_ua(&f.fw, 0, 60000) == 1000000);
    CHECK(haptics_firmware_current_ua(&f.fw, 0, -6) == -100);
    f.fw.calibration.axis[0].torque_constant_unm_per_a = 1;
    CHECK(haptics_firmware_current_ua(&f.fw, 0, std::numeric_limits<std::int32_t>::max()) == 0x7FFFFFFF);
    CHECK(haptics_firmware_current_ua(&f.fw, 0, std::numeric_limits<std::int32_t>::min()) == -0x7FFFFFFF);
    f.fw.calibration.axis[0].torque_constant_unm_per_a = 0;
    CHECK(haptics_firmware_current_ua(&f.fw, 0, 1000) == 0);
    CHECK(haptics_firmware_current_ua(&f.fw, 9, 1000) == 0);
}
