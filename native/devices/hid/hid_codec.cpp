// Every report is: id, version, body, CRC-32 of all before it. Numbers are put together from single bytes, so
// that neither the machine's byte order nor its alignment matters.

#include <haptics/devices/hid/hid_codec.hpp>

#include <algorithm>

namespace haptics {

namespace {

using Bytes = std::span<const std::uint8_t>;

constexpr std::array<std::uint32_t, 256> make_crc_table() {
    std::array<std::uint32_t, 256> table{};
    for (std::uint32_t i = 0; i < 256; ++i) {
        std::uint32_t c = i;
        for (int bit = 0; bit < 8; ++bit)
            c = (c & 1U) != 0U ? (c >> 1U) ^ HAPTICS_CRC_REFLECTED_POLYNOMIAL : c >> 1U;
        table[i] = c;
    }
    return table;
}
constexpr std::array<std::uint32_t, 256> k_crc_table = make_crc_table();

std::uint32_t get_u16(Bytes b, std::size_t at) {
    return static_cast<std::uint32_t>(b[at]) | (static_cast<std::uint32_t>(b[at + 1]) << 8U);
}
std::uint32_t get_u32(Bytes b, std::size_t at) {
    return get_u16(b, at) | (get_u16(b, at + 2) << 16U);
}
std::int32_t get_i32(Bytes b, std::size_t at) {
    return static_cast<std::int32_t>(get_u32(b, at));
}

void put_u16(std::span<std::uint8_t> b, std::size_t at, std::uint32_t value) {
    b[at] = static_cast<std::uint8_t>(value & 0xFFU);
    b[at + 1] = static_cast<std::uint8_t>((value >> 8U) & 0xFFU);
}
void put_u32(std::span<std::uint8_t> b, std::size_t at, std::uint32_t value) {
    put_u16(b, at, value & 0xFFFFU);
    put_u16(b, at + 2, value >> 16U);
}
void seal(std::span<std::uint8_t> b, std::size_t crc_at) {
    put_u32(b, crc_at, hid_crc32(b.first(crc_at)));
}

// what all reports have in common
HidDecode open_report(Bytes b, std::uint8_t id, std::size_t size) {
    if (b.size() != size)
        return HidDecode::wrong_size;
    if (b[0] != id)
        return HidDecode::wrong_id;
    const std::size_t crc_at = size - 4;
    if (get_u32(b, crc_at) != hid_crc32(b.first(crc_at)))
        return HidDecode::wrong_crc;
    return b[1] == HAPTICS_PROTOCOL_VERSION ? HidDecode::good : HidDecode::wrong_version;
}

bool within(double value, double low, double high) {
    return value >= low && value <= high;
}

// the ranges of PantographGeometry, in the wire's units
bool usable(const HidAxis& a) {
    constexpr double k_four_pi = 12'566'371.0;
    return within(a.offset_urad, -k_four_pi, k_four_pi) && within(a.counts_per_turn, 16.0, 1.0e9) &&
           within(a.gear_millionths, 1.0e5, 5.0e8) && within(a.torque_constant_unm_per_a, 100.0, 1.0e7) &&
           within(a.torque_limit_unm, 100.0, 5.0e7);
}

bool usable(const HidIdentity& i) {
    const bool five_bar = i.kind == HAPTICS_KIND_FIVE_BAR && i.encoders == 2 && i.motors == 2;
    const bool twin = i.kind == HAPTICS_KIND_TWIN_FIVE_BAR && i.encoders == 4 && i.motors == 4;
    return (five_bar || twin) && within(i.interval_us, 100.0, 20000.0) &&
           within(i.watchdog_us, 1000.0, 1.0e6);
}

// printable ASCII up to the first zero, zeros after it
bool read_serial(Bytes b, HidIdentity& identity) {
    bool ended = false;
    for (std::size_t i = 0; i < HAPTICS_SERIAL_SIZE; ++i) {
        const std::uint8_t c = b[HAPTICS_IDENTITY_AT_SERIAL + i];
        ended = ended || c == 0;
        if (ended ? c != 0 : (c < 0x20 || c > 0x7E))
            return false;
        identity.serial[i] = static_cast<char>(c);
    }
    return true;
}

} // namespace

std::uint32_t hid_crc32(Bytes bytes) noexcept {
    std::uint32_t crc = 0xFFFFFFFFU;
    for (const std::uint8_t byte : bytes)
        crc = (crc >> 8U) ^ k_crc_table[(crc ^ byte) & 0xFFU];
    return ~crc;
}

HidDecode decode_input(Bytes b, HidSample& sample) noexcept {
    const HidDecode found = open_report(b, HAPTICS_INPUT_ID, HAPTICS_INPUT_SIZE);
    if (found != HidDecode::good)
        return found;
    sample.status = static_cast<std::uint16_t>(get_u16(b, HAPTICS_INPUT_AT_STATUS) & HAPTICS_STATUS_KNOWN);
    sample.sequence = get_u32(b, HAPTICS_INPUT_AT_SEQUENCE);
    sample.time_us = get_u32(b, HAPTICS_INPUT_AT_TIME);
    for (std::size_t i = 0; i < k_hid_axes; ++i)
        sample.count[i] = get_i32(b, HAPTICS_INPUT_AT_COUNT + 4 * i);
    for (std::size_t i = 0; i < 3; ++i)
        sample.hand_force[i] = get_i32(b, HAPTICS_INPUT_AT_HAND_FORCE + 4 * i);
    sample.buttons = get_u32(b, HAPTICS_INPUT_AT_BUTTONS);
    sample.command = get_u32(b, HAPTICS_INPUT_AT_COMMAND);
    sample.homings = b[HAPTICS_INPUT_AT_HOMINGS];
    sample.refused = b[HAPTICS_INPUT_AT_REFUSED];
    return HidDecode::good;
}

void encode_command(const HidCommand& command, std::span<std::uint8_t, HAPTICS_OUTPUT_SIZE> bytes) noexcept {
    bytes[HAPTICS_OUTPUT_AT_ID] = HAPTICS_OUTPUT_ID;
    bytes[HAPTICS_OUTPUT_AT_VERSION] = HAPTICS_PROTOCOL_VERSION;
    put_u16(bytes, HAPTICS_OUTPUT_AT_FLAGS, command.enable ? HAPTICS_FLAG_ENABLE : 0U);
    put_u32(bytes, HAPTICS_OUTPUT_AT_SEQUENCE, command.sequence);
    for (std::size_t i = 0; i < k_hid_axes; ++i)
        put_u32(bytes, HAPTICS_OUTPUT_AT_TORQUE + 4 * i, static_cast<std::uint32_t>(command.torque[i]));
    put_u32(bytes, HAPTICS_OUTPUT_AT_INPUT, command.input);
    seal(bytes, HAPTICS_OUTPUT_AT_CRC);
}

HidDecode decode_identity(Bytes b, HidIdentity& identity, int& version) noexcept {
    const HidDecode found = open_report(b, HAPTICS_IDENTITY_ID, HAPTICS_IDENTITY_SIZE);
    // the first two bytes and the seal at the end stay in every version to come
    version = b.size() > 1 ? b[1] : 0;
    if (found != HidDecode::good)
        return found;
    HidIdentity read;
    read.kind = b[HAPTICS_IDENTITY_AT_KIND];
    read.encoders = b[HAPTICS_IDENTITY_AT_ENCODERS];
    read.motors = b[HAPTICS_IDENTITY_AT_MOTORS];
    read.capabilities = b[HAPTICS_IDENTITY_AT_CAPABILITIES];
    read.major = b[HAPTICS_IDENTITY_AT_FIRMWARE];
    read.minor = b[HAPTICS_IDENTITY_AT_FIRMWARE + 1];
    read.interval_us = get_u32(b, HAPTICS_IDENTITY_AT_INTERVAL);
    read.watchdog_us = get_u32(b, HAPTICS_IDENTITY_AT_WATCHDOG);
    if (!read_serial(b, read) || !usable(read))
        return HidDecode::out_of_range;
    identity = read;
    return HidDecode::good;
}

HidDecode decode_calibration(Bytes b, std::size_t axes, HidCalibration& calibration) noexcept {
    const HidDecode found = open_report(b, HAPTICS_CALIBRATION_ID, HAPTICS_CALIBRATION_SIZE);
    if (found != HidDecode::good)
        return found;
    HidCalibration read;
    const std::uint8_t reversed = b[HAPTICS_CALIBRATION_AT_REVERSED];
    for (std::size_t i = 0; i < std::min(axes, k_hid_axes); ++i) {
        const std::size_t at = HAPTICS_CALIBRATION_AT_AXIS + HAPTICS_AXIS_SIZE * i;
        HidAxis& axis = read.axis[i];
        axis.offset_urad = get_i32(b, at + HAPTICS_AXIS_AT_OFFSET);
        axis.counts_per_turn = get_u32(b, at + HAPTICS_AXIS_AT_COUNTS);
        axis.gear_millionths = get_u32(b, at + HAPTICS_AXIS_AT_GEAR);
        axis.torque_constant_unm_per_a = get_u32(b, at + HAPTICS_AXIS_AT_TORQUE_CONSTANT);
        axis.torque_limit_unm = get_u32(b, at + HAPTICS_AXIS_AT_TORQUE_LIMIT);
        axis.reversed = ((reversed >> i) & 1U) != 0U;
        if (!usable(axis))
            return HidDecode::out_of_range;
    }
    for (std::size_t i = 0; i < 3; ++i) {
        read.home[i] = get_i32(b, HAPTICS_CALIBRATION_AT_HOME + 4 * i);
        if (!within(read.home[i], -4.0e6, 4.0e6))
            return HidDecode::out_of_range;
    }
    calibration = read;
    return HidDecode::good;
}

void encode_action(std::uint8_t action, std::span<std::uint8_t, HAPTICS_ACTION_SIZE> bytes) noexcept {
    bytes[HAPTICS_ACTION_AT_ID] = HAPTICS_ACTION_ID;
    bytes[HAPTICS_ACTION_AT_VERSION] = HAPTICS_PROTOCOL_VERSION;
    bytes[HAPTICS_ACTION_AT_ACTION] = action;
    bytes[HAPTICS_ACTION_AT_RESULT] = HAPTICS_RESULT_NONE;
    seal(bytes, HAPTICS_ACTION_AT_CRC);
}

HidDecode decode_action(Bytes b, std::uint8_t& action, std::uint8_t& result) noexcept {
    const HidDecode found = open_report(b, HAPTICS_ACTION_ID, HAPTICS_ACTION_SIZE);
    if (found != HidDecode::good)
        return found;
    action = b[HAPTICS_ACTION_AT_ACTION];
    result = b[HAPTICS_ACTION_AT_RESULT];
    return HidDecode::good;
}

} // namespace haptics
