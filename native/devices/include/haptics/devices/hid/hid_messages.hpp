#pragma once
/// What host and device tell each other, as plain structures. The bytes are in haptics_firmware/protocol.h,
/// the meaning in docs/hid-protocol.md.

#include <haptics_firmware/protocol.h>

#include <array>
#include <cstddef>
#include <cstdint>

namespace haptics {

/// Axes that a report has room for.
inline constexpr std::size_t k_hid_axes = HAPTICS_AXES;

/// One input report.
struct HidSample {
    /// HAPTICS_STATUS_* bits.
    std::uint16_t status{0};
    /// One more in each report; wraps.
    std::uint32_t sequence{0};
    /// Device's clock when the encoders were read, us; wraps.
    std::uint32_t time_us{0};
    /// Encoder counts, 0 at the home pose.
    std::array<std::int32_t, k_hid_axes> count{};
    /// Hand on handle, uN, uN, uN m, device frame; of use when HAPTICS_STATUS_HAND_FORCE is set.
    std::array<std::int32_t, 3> hand_force{};
    /// Bit i is button i.
    std::uint32_t buttons{0};
    /// Sequence of the last command that the device took.
    std::uint32_t command{0};
    /// Times homed, and commands refused, since power-on; wrap.
    std::uint8_t homings{0};
    std::uint8_t refused{0};
};

/// One output report.
struct HidCommand {
    /// Motors follow `torque`; false lets them go.
    bool enable{false};
    /// One more in each command; wraps.
    std::uint32_t sequence{0};
    /// Torques of the motor shafts, uN m, in the joints' counter-clockwise direction.
    std::array<std::int32_t, k_hid_axes> torque{};
    /// Sequence of the input report that this answers.
    std::uint32_t input{0};
};

/// What a device is.
struct HidIdentity {
    /// HAPTICS_KIND_*.
    std::uint8_t kind{0};
    std::uint8_t encoders{0};
    std::uint8_t motors{0};
    /// HAPTICS_CAN_* bits.
    std::uint8_t capabilities{0};
    /// Version of its firmware.
    std::uint8_t major{0};
    std::uint8_t minor{0};
    /// ASCII, ends with a zero.
    std::array<char, HAPTICS_SERIAL_SIZE + 1> serial{};
    /// Time between input reports, us.
    std::uint32_t interval_us{0};
    /// Time without a valid command after which it lets its motors go, us.
    std::uint32_t watchdog_us{0};
};

/// One axis of a calibration.
struct HidAxis {
    /// Joint angle at count 0, urad.
    std::int32_t offset_urad{0};
    /// Counts per turn of the motor shaft, all quadrature edges.
    std::uint32_t counts_per_turn{0};
    /// Motor turns per million joint turns.
    std::uint32_t gear_millionths{0};
    /// uN m per A, and uN m, at the motor shaft.
    std::uint32_t torque_constant_unm_per_a{0};
    std::uint32_t torque_limit_unm{0};
    /// Counts grow clockwise.
    bool reversed{false};
};

/// What counts and torques mean.
struct HidCalibration {
    std::array<HidAxis, k_hid_axes> axis{};
    /// Handle pose at count 0 of all axes, um, um, urad, device frame.
    std::array<std::int32_t, 3> home{};
};

} // namespace haptics
