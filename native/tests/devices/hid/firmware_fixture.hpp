#pragma once
/// A device's firmware with figures of its own, and commands to it.

#include <haptics/devices/hid/hid_codec.hpp>

#include <haptics_firmware/firmware.h>

#include <array>
#include <cstring>

namespace haptics::testing {

inline haptics_identity make_identity() {
    haptics_identity id{};
    id.kind = HAPTICS_KIND_TWIN_FIVE_BAR;
    id.encoders = 4;
    id.motors = 4;
    id.capabilities = HAPTICS_CAN_MEASURE_HAND_FORCE;
    id.major = 1;
    id.minor = 7;
    std::memcpy(id.serial, "A-17", 4);
    id.interval_us = 1000;
    return id;
}

inline haptics_calibration make_calibration() {
    haptics_calibration c{};
    c.reversed = 0x0A;
    for (std::uint32_t i = 0; i < HAPTICS_AXES; ++i)
        c.axis[i] = {-1570796 + static_cast<std::int32_t>(i), 65536, 4000000, 60000, 600000 + i};
    c.home[0] = -1000;
    c.home[1] = 2000;
    c.home[2] = -3;
    return c;
}

/// A device with absolute encoders and a clock that a test moves.
struct FirmwareFixture {
    explicit FirmwareFixture(bool absolute = true, std::uint32_t start_us = 0)
        : now(start_us) {
        const haptics_identity id = make_identity();
        const haptics_calibration c = make_calibration();
        haptics_firmware_init(&fw, &id, &c, now);
        board.absolute = absolute;
        measure();
    }
    void measure() { haptics_firmware_sample(&fw, &board, now); }
    /// A command with the next sequence number.
    haptics_verdict send(bool enable, std::int32_t torque) {
        return send_bytes(bytes_of(enable, torque, ++sequence));
    }
    static std::array<std::uint8_t, HAPTICS_OUTPUT_SIZE> bytes_of(bool enable, std::int32_t torque,
                                                                  std::uint32_t sequence) {
        HidCommand c;
        c.enable = enable;
        c.sequence = sequence;
        c.torque.fill(torque);
        std::array<std::uint8_t, HAPTICS_OUTPUT_SIZE> bytes{};
        encode_command(c, bytes);
        return bytes;
    }
    template <class Bytes>
    haptics_verdict send_bytes(const Bytes& bytes) {
        return haptics_firmware_command(&fw, bytes.data(), bytes.size(), now);
    }
    /// The motors' torques now; the answer is the one of axis 0.
    std::int32_t torque() {
        driven = haptics_firmware_torques(&fw, now, torques.data());
        return torques[0];
    }
    HidSample report() {
        std::array<std::uint8_t, HAPTICS_INPUT_SIZE> bytes{};
        haptics_firmware_input(&fw, now, bytes.data());
        HidSample sample;
        decoded = decode_input(bytes, sample);
        return sample;
    }
    haptics_verdict act(std::uint8_t action) {
        std::array<std::uint8_t, HAPTICS_ACTION_SIZE> bytes{};
        encode_action(action, bytes);
        return haptics_firmware_set_feature(&fw, bytes.data(), bytes.size(), now);
    }

    haptics_firmware fw{};
    haptics_sample board{};
    std::uint32_t now;
    std::uint32_t sequence{0};
    bool driven{false};
    std::array<std::int32_t, HAPTICS_AXES> torques{};
    HidDecode decoded{HidDecode::good};
};

} // namespace haptics::testing
