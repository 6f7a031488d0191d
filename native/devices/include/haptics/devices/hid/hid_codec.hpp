#pragma once
/// Between structures and bytes. Pure: no input or output, no allocation, no exception; safe on any bytes.

#include <haptics/devices/hid/hid_messages.hpp>

#include <span>

namespace haptics {

/// What is wrong with received bytes.
enum class HidDecode : std::uint8_t {
    good,
    wrong_size,    ///< too short or too long
    wrong_id,      ///< another kind of report
    wrong_crc,     ///< damaged on the way
    wrong_version, ///< whole, but of another protocol
    out_of_range,  ///< whole, but a figure makes no sense
};

/// CRC-32/ISO-HDLC; the check value is HAPTICS_CRC_CHECK.
[[nodiscard]] std::uint32_t hid_crc32(std::span<const std::uint8_t> bytes) noexcept;

/// Reads an input report. `sample` is written only when the answer is `good`.
[[nodiscard]] HidDecode decode_input(std::span<const std::uint8_t> bytes, HidSample& sample) noexcept;
/// Writes an output report.
void encode_command(const HidCommand& command, std::span<std::uint8_t, HAPTICS_OUTPUT_SIZE> bytes) noexcept;

/// Reads an identity. With wrong_version, `version` says which.
[[nodiscard]] HidDecode decode_identity(std::span<const std::uint8_t> bytes, HidIdentity& identity,
                                        int& version) noexcept;
/// Reads a calibration of a device with `axes` axes; those beyond are zero.
[[nodiscard]] HidDecode decode_calibration(std::span<const std::uint8_t> bytes, std::size_t axes,
                                           HidCalibration& calibration) noexcept;

/// Writes the request for an action (HAPTICS_ACTION_*).
void encode_action(std::uint8_t action, std::span<std::uint8_t, HAPTICS_ACTION_SIZE> bytes) noexcept;
/// Reads how the last action went (HAPTICS_RESULT_*).
[[nodiscard]] HidDecode decode_action(std::span<const std::uint8_t> bytes, std::uint8_t& action,
                                      std::uint8_t& result) noexcept;

} // namespace haptics
