// Driver and firmware against bytes made apart from both, against each other, and against noise.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <support/random.hpp>
#include <vector>

#include "devices/hid/firmware_fixture.hpp"
#include "devices/hid/golden_reports.hpp"

using namespace haptics;
using namespace haptics::testing;

namespace {

using Bytes = std::vector<std::uint8_t>;

void fill(Random& random, std::span<std::uint8_t> bytes) {
    std::uint64_t bits = 0;
    for (std::size_t i = 0; i < bytes.size(); ++i) {
        if (i % 8 == 0)
            bits = random.bits();
        bytes[i] = static_cast<std::uint8_t>(bits >> (8 * (i % 8)));
    }
}

void seal(std::span<std::uint8_t> bytes) {
    const std::uint32_t crc = haptics_firmware_crc32(bytes.data(), bytes.size() - 4);
    for (std::size_t i = 0; i < 4; ++i)
        bytes[bytes.size() - 4 + i] = static_cast<std::uint8_t>(crc >> (8 * i));
}

std::int32_t any_int(Random& random) {
    return static_cast<std::int32_t>(random.bits());
}

bool sane(const HidIdentity& i) {
    return (i.motors == 2 || i.motors == 4) && i.encoders == i.motors && i.watchdog_us >= 1000 &&
           i.watchdog_us <= 1000000 && i.interval_us >= 100 && i.interval_us <= 20000 &&
           i.serial.back() == '\0';
}

// everything that the driver computes from a calibration stays a number
bool sane(const HidCalibration& c, std::size_t axes) {
    for (std::size_t i = 0; i < axes; ++i) {
        const HidAxis& a = c.axis[i];
        const double gear = a.gear_millionths * 1e-6;
        const double angle = a.offset_urad * 1e-6 + 2147483648.0 / (a.counts_per_turn * gear);
        const double torque = 1e6 / gear;
        if (!std::isfinite(angle) || !std::isfinite(torque) || gear < 0.1 || gear > 500.0 ||
            a.counts_per_turn < 16 || a.torque_limit_unm > 50000000 || std::abs(a.offset_urad) > 12566371)
            return false;
    }
    return std::all_of(c.home.begin(), c.home.end(), [](std::int32_t v) { return std::abs(v) <= 4000000; });
}

} // namespace

TEST_CASE("both checksums are CRC-32/ISO-HDLC") {
    const std::string text = "123456789";
    const auto* const bytes = reinterpret_cast<const std::uint8_t*>(text.data());
    CHECK(hid_crc32({bytes, text.size()}) == HAPTICS_CRC_CHECK);
    CHECK(haptics_firmware_crc32(bytes, text.size()) == HAPTICS_CRC_CHECK);
    CHECK(haptics_firmware_crc32(bytes, 0) == 0);
    CHECK(hid_crc32({}) == 0);
}

TEST_CASE("the driver reads and writes the golden bytes") {
    HidSample s;
    REQUIRE(decode_input(k_golden_input, s) == HidDecode::good);
    CHECK(s.status == (HAPTICS_STATUS_HOMED | HAPTICS_STATUS_ENABLED | HAPTICS_STATUS_HAND_FORCE));
    CHECK(s.sequence == 0x01020304);
    CHECK(s.time_us == 0xFFFFFFFE);
    CHECK(s.count == std::array<std::int32_t, 4>{-1, 2147483647, -2147483647 - 1, 1234});
    CHECK(s.hand_force == std::array<std::int32_t, 3>{-2000000, 1500000, -7});
    CHECK(s.buttons == 5);
    CHECK(s.command == 0x0A0B0C0D);
    CHECK(s.homings == 3);
    CHECK(s.refused == 250);

    HidCommand c;
    c.enable = true;
    c.sequence = 0xFFFFFFFF;
    c.torque = {-600000, 600000, 1, -1};
    c.input = 0x01020304;
    std::array<std::uint8_t, HAPTICS_OUTPUT_SIZE> bytes{};
    encode_command(c, bytes);
    CHECK(bytes == k_golden_command);

    HidIdentity id;
    int version = 0;
    REQUIRE(decode_identity(k_golden_identity, id, version) == HidDecode::good);
    CHECK(version == 1);
    CHECK(std::string(id.serial.data()) == "A-17");
    CHECK(id.kind == HAPTICS_KIND_TWIN_FIVE_BAR);
    CHECK(id.capabilities == HAPTICS_CAN_MEASURE_HAND_FORCE);
    CHECK(id.major == 1);
    CHECK(id.minor == 7);
    CHECK(id.interval_us == 1000);
    CHECK(id.watchdog_us == HAPTICS_WATCHDOG_US);

    HidCalibration k;
    REQUIRE(decode_calibration(k_golden_calibration, 4, k) == HidDecode::good);
    CHECK(k.axis[2].offset_urad == -1570794);
    CHECK(k.axis[3].reversed);
    CHECK_FALSE(k.axis[2].reversed);
    CHECK(k.axis[1].gear_millionths == 4000000);
    CHECK(k.axis[1].torque_limit_unm == 600001);
    CHECK(k.home == std::array<std::int32_t, 3>{-1000, 2000, -3});

    std::array<std::uint8_t, HAPTICS_ACTION_SIZE> action{};
    encode_action(HAPTICS_ACTION_HOME_HERE, action);
    CHECK(action == k_golden_action);
}

TEST_CASE("the firmware writes and reads the golden bytes") {
    FirmwareFixture f(false);
    f.now = 0xFFFFFFFE;
    f.fw.homed = true;
    f.fw.watchdog = false;
    f.fw.command_us = f.now;
    f.fw.enabled = true;
    f.fw.input_sequence = 0x01020303;
    f.fw.command_sequence = 0x0A0B0C0D;
    f.fw.homings = 3;
    f.fw.refused = 250;
    f.board.count[0] = -1;
    f.board.count[1] = 2147483647;
    f.board.count[2] = -2147483647 - 1;
    f.board.count[3] = 1234;
    f.board.hand_force[0] = -2000000;
    f.board.hand_force[1] = 1500000;
    f.board.hand_force[2] = -7;
    f.board.force_valid = true;
    f.board.buttons = 5;
    f.measure();
    std::array<std::uint8_t, HAPTICS_INPUT_SIZE> bytes{};
    haptics_firmware_input(&f.fw, f.now, bytes.data());
    CHECK(bytes == k_golden_input);

    Bytes feature(200);
    feature.resize(haptics_firmware_get_feature(&f.fw, HAPTICS_IDENTITY_ID, feature.data(), feature.size()));
    CHECK(feature == Bytes(k_golden_identity.begin(), k_golden_identity.end()));
    feature.assign(200, 0xEE);
    feature.resize(
        haptics_firmware_get_feature(&f.fw, HAPTICS_CALIBRATION_ID, feature.data(), feature.size()));
    CHECK(feature == Bytes(k_golden_calibration.begin(), k_golden_calibration.end()));
    CHECK(haptics_firmware_get_feature(&f.fw, 77, feature.data(), feature.size()) == 0);
    CHECK(haptics_firmware_get_feature(&f.fw, HAPTICS_CALIBRATION_ID, feature.data(), 99) == 0);

    CHECK(f.send_bytes(k_golden_command) == HAPTICS_TAKEN);
    CHECK(f.torque() == -600000);
    CHECK(f.torques == std::array<std::int32_t, 4>{-600000, 600000, 1, -1});
    CHECK(haptics_firmware_set_feature(&f.fw, k_golden_action.data(), k_golden_action.size(), f.now) ==
          HAPTICS_REFUSED);
}

TEST_CASE("whatever the firmware measures, the driver reads") {
    Random random(1);
    FirmwareFixture f(true);
    int wrong = 0;
    for (int n = 0; n < 200000; ++n) {
        f.now = static_cast<std::uint32_t>(random.bits());
        for (int& count : f.board.count)
            count = any_int(random);
        for (int& force : f.board.hand_force)
            force = any_int(random);
        f.board.force_valid = random.below(2) == 1;
        f.board.buttons = static_cast<std::uint32_t>(random.bits());
        f.measure();
        const HidSample s = f.report();
        const bool has_force = (s.status & HAPTICS_STATUS_HAND_FORCE) != 0;
        wrong += f.decoded != HidDecode::good || s.time_us != f.now || s.buttons != f.board.buttons ||
                 !std::equal(s.count.begin(), s.count.end(), f.board.count) ||
                 has_force != f.board.force_valid ||
                 (has_force && !std::equal(s.hand_force.begin(), s.hand_force.end(), f.board.hand_force)) ||
                 s.sequence != static_cast<std::uint32_t>(n + 1);
    }
    CHECK(wrong == 0);
}

TEST_CASE("noise is never taken for a report") {
    Random random(2);
    std::array<std::uint8_t, 128> bytes{};
    int taken = 0;
    HidSample sample;
    HidIdentity identity;
    HidCalibration calibration;
    FirmwareFixture f;
    constexpr std::array<std::size_t, 5> k_sizes{HAPTICS_INPUT_SIZE, HAPTICS_OUTPUT_SIZE,
                                                 HAPTICS_IDENTITY_SIZE, HAPTICS_CALIBRATION_SIZE,
                                                 HAPTICS_ACTION_SIZE};
    // a checksum of 32 bits lets one in 4e9 through, and these seeds have none
    for (int n = 0; n < 3000000; ++n) {
        const auto kind = static_cast<std::size_t>(random.below(8));
        const std::size_t size =
            kind < 5 ? k_sizes[kind] : static_cast<std::size_t>(random.below(static_cast<int>(bytes.size())));
        const std::span<std::uint8_t> some(bytes.data(), size);
        fill(random, some);
        // the right beginning, so that the rest is looked at
        if (size > 1 && kind < 5) {
            some[0] = static_cast<std::uint8_t>(kind + 1);
            some[1] = HAPTICS_PROTOCOL_VERSION;
        }
        int version = 0;
        std::uint8_t action = 0;
        std::uint8_t result = 0;
        taken += decode_input(some, sample) == HidDecode::good;
        taken += decode_identity(some, identity, version) == HidDecode::good;
        taken += decode_calibration(some, 4, calibration) == HidDecode::good;
        taken += decode_action(some, action, result) == HidDecode::good;
        taken += haptics_firmware_command(&f.fw, some.data(), size, f.now) == HAPTICS_TAKEN;
        const haptics_verdict set = haptics_firmware_set_feature(&f.fw, some.data(), size, f.now);
        taken += set == HAPTICS_TAKEN || set == HAPTICS_REFUSED;
    }
    CHECK(taken == 0);
    // what is not taken leaves no trace
    CHECK(sample.sequence == 0);
    CHECK(identity.kind == 0);
    CHECK_FALSE(f.fw.has_command);
}

TEST_CASE("every damage of up to four bits, and every burst of up to 32, is seen") {
    // 416 bits of body: CRC-32 has a Hamming distance of 5 there, and finds every burst no longer than itself
    Random random(3);
    HidSample sample;
    int taken = 0;
    const auto judge = [&](const std::array<std::uint8_t, HAPTICS_INPUT_SIZE>& bytes) {
        taken += decode_input(bytes, sample) == HidDecode::good;
    };
    const auto flip = [](auto& bytes, int bit) {
        bytes[static_cast<std::size_t>(bit / 8)] ^= static_cast<std::uint8_t>(1U << (bit % 8));
    };
    constexpr int k_bits = 8 * static_cast<int>(HAPTICS_INPUT_SIZE);
    for (int a = 0; a < k_bits; ++a) {
        auto one = k_golden_input;
        flip(one, a);
        judge(one);
        for (int b = a + 1; b < k_bits; ++b) {
            auto two = one;
            flip(two, b);
            judge(two);
        }
    }
    for (int n = 0; n < 300000; ++n) {
        auto bytes = k_golden_input;
        std::array<int, 4> bit{};
        for (std::size_t i = 0; i < bit.size(); ++i)
            do
                bit[i] = random.below(k_bits);
            while (std::find(bit.begin(), bit.begin() + static_cast<std::ptrdiff_t>(i), bit[i]) !=
                   bit.begin() + static_cast<std::ptrdiff_t>(i));
        const int count = 3 + random.below(2);
        for (int i = 0; i < count; ++i)
            flip(bytes, bit[static_cast<std::size_t>(i)]);
        judge(bytes);

        bytes = k_golden_input;
        const int length = 2 + random.below(31);
        const int first = random.below(k_bits - length + 1);
        const std::uint64_t pattern = random.bits();
        flip(bytes, first);
        for (int i = 1; i < length - 1; ++i)
            if (((pattern >> i) & 1U) != 0U)
                flip(bytes, first + i);
        flip(bytes, first + length - 1);
        judge(bytes);
    }
    CHECK(taken == 0);
}

TEST_CASE("sealed nonsense is out of range or harmless") {
    Random random(4);
    int good = 0;
    int bad = 0;
    for (int n = 0; n < 400000; ++n) {
        Bytes bytes = n % 2 == 0 ? Bytes(k_golden_identity.begin(), k_golden_identity.end())
                                 : Bytes(k_golden_calibration.begin(), k_golden_calibration.end());
        // some bytes of the body become anything
        for (int changes = random.below(4); changes >= 0; --changes)
            bytes[2 + static_cast<std::size_t>(random.below(static_cast<int>(bytes.size()) - 6))] =
                static_cast<std::uint8_t>(random.below(3) == 0 ? 0xFF * random.below(2) : random.below(256));
        seal(bytes);
        HidIdentity identity;
        HidCalibration calibration;
        int version = 0;
        const HidDecode found = n % 2 == 0 ? decode_identity(bytes, identity, version)
                                           : decode_calibration(bytes, 4, calibration);
        if (found == HidDecode::good)
            ++good;
        bad += found == HidDecode::good ? (n % 2 == 0 ? !sane(identity) : !sane(calibration, 4))
                                        : found != HidDecode::out_of_range;
    }
    CHECK(bad == 0);
    CHECK(good > 1000); // otherwise nothing was tested
}

TEST_CASE("a report of another protocol is told from a damaged one") {
    auto other = k_golden_identity;
    other[1] = 2;
    seal(other);
    HidIdentity identity;
    int version = 0;
    CHECK(decode_identity(other, identity, version) == HidDecode::wrong_version);
    CHECK(version == 2);
    other[9] ^= 1U;
    CHECK(decode_identity(other, identity, version) == HidDecode::wrong_crc);
    HidSample sample;
    CHECK(decode_input(std::span(k_golden_input).first(55), sample) == HidDecode::wrong_size);
    CHECK(decode_input(k_golden_action, sample) == HidDecode::wrong_size);
    CHECK(decode_input({}, sample) == HidDecode::wrong_size);
}
