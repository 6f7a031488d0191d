/* Safety rules, in the order in which they win:
 *   1. Motors are driven only while enabled, homed, without any fault, and within 20 ms of the last valid
 * command.
 *   2. Whatever is wrong with a command (size, id, version, checksum, old sequence) leaves everything as it
 * was, so that noise on the wire can neither drive a motor nor keep the watchdog quiet.
 *   3. Once the motors were let go for any of these reasons, force does not come back with the next command:
 * the host must first say, by a command without enable, that it knows.
 *   4. Torques are cut to the limit of each axis here, whatever the host believes. */

#include <haptics_firmware/firmware.h>
#include <string.h>

#include "wire.h"

/* a handle that stayed within so small a part of a motor's turn for so long is at rest */
#define REST_PART_OF_TURN 256u
#define REST_US 100000u

static void let_go(haptics_firmware* fw) {
    unsigned i;
    fw->enabled = false;
    for (i = 0; i < HAPTICS_AXES; ++i) {
        fw->torque_unm[i] = 0;
    }
}

static bool may_drive(const haptics_firmware* fw) {
    return fw->homed && !fw->tripped && !fw->watchdog && !fw->driver_fault && !fw->sample.stop_pressed &&
           !fw->sample.hot && !fw->sample.encoder_fault;
}

static void watch_time(haptics_firmware* fw, uint32_t now_us) {
    /* unsigned, so the wrap of the clock does not matter; once set it stays, so neither does its second round
     */
    if (!fw->watchdog && now_us - fw->command_us > HAPTICS_WATCHDOG_US) {
        fw->watchdog = true;
    }
    if (fw->enabled && !may_drive(fw)) {
        fw->tripped = true;
        let_go(fw);
    }
}

void haptics_firmware_init(haptics_firmware* fw, const haptics_identity* identity,
                           const haptics_calibration* calibration, uint32_t now_us) {
    memset(fw, 0, sizeof *fw);
    fw->identity = *identity;
    fw->calibration = *calibration;
    fw->command_us = now_us;
    fw->rest_us = now_us;
    fw->watchdog = true;
}

static int32_t within(int32_t torque, uint32_t limit_unm, bool* cut) {
    const int32_t limit = limit_unm > 0x7FFFFFFFu ? 0x7FFFFFFF : (int32_t)limit_unm;
    if (torque > limit) {
        *cut = true;
        return limit;
    }
    if (torque < -limit) {
        *cut = true;
        return -limit;
    }
    return torque;
}

static haptics_verdict judge_command(const haptics_firmware* fw, const uint8_t* report, size_t size) {
    uint32_t ahead;
    if (size != HAPTICS_OUTPUT_SIZE) {
        return HAPTICS_WRONG_SIZE;
    }
    if (report[HAPTICS_OUTPUT_AT_ID] != HAPTICS_OUTPUT_ID) {
        return HAPTICS_WRONG_ID;
    }
    if (!haptics_is_sealed(report, HAPTICS_OUTPUT_AT_CRC)) {
        return HAPTICS_WRONG_CRC;
    }
    if (report[HAPTICS_OUTPUT_AT_VERSION] != HAPTICS_PROTOCOL_VERSION) {
        return HAPTICS_WRONG_VERSION;
    }
    /* a half turn of the counter is ahead, the other half behind. After a silence any number starts anew: the
     * host was restarted. */
    ahead = haptics_get_u32(report + HAPTICS_OUTPUT_AT_SEQUENCE) - fw->command_sequence;
    if (fw->has_command && !fw->watchdog && (ahead == 0u || ahead >= 0x80000000u)) {
        return HAPTICS_OLD_SEQUENCE;
    }
    return HAPTICS_TAKEN;
}

haptics_verdict haptics_firmware_command(haptics_firmware* fw, const uint8_t* report, size_t size,
                                         uint32_t now_us) {
    haptics_verdict verdict;
    bool enable;
    unsigned i;
    watch_time(fw, now_us);
    verdict = judge_command(fw, report, size);
    if (verdict != HAPTICS_TAKEN) {
        fw->refused = (uint8_t)(fw->refused + 1u);
        return verdict;
    }
    fw->command_sequence = haptics_get_u32(report + HAPTICS_OUTPUT_AT_SEQUENCE);
    fw->has_command = true;
    fw->clamped = false;
    enable = (haptics_get_u16(report + HAPTICS_OUTPUT_AT_FLAGS) & HAPTICS_FLAG_ENABLE) != 0u;
    if (!enable) {
        fw->watchdog = false;
        fw->tripped = false;
    }
    if (!fw->watchdog) {
        fw->command_us = now_us;
    }
    if (!enable || !may_drive(fw)) {
        /* asked for in vain: it must be asked for again */
        fw->tripped = enable;
        let_go(fw);
        return HAPTICS_TAKEN;
    }
    fw->enabled = true;
    for (i = 0; i < HAPTICS_AXES; ++i) {
        const uint32_t limit = i < fw->identity.motors ? fw->calibration.axis[i].torque_limit_unm : 0u;
        fw->torque_unm[i] =
            within(haptics_get_i32(report + HAPTICS_OUTPUT_AT_TORQUE + 4u * i), limit, &fw->clamped);
    }
    return HAPTICS_TAKEN;
}

/* difference of two counters that may have wrapped */
static int32_t difference(int32_t a, int32_t b) {
    const uint32_t bits = (uint32_t)a - (uint32_t)b;
    return bits <= 0x7FFFFFFFu ? (int32_t)bits : -(int32_t)(0xFFFFFFFFu - bits) - 1;
}

static void watch_rest(haptics_firmware* fw, uint32_t now_us) {
    bool moved = !fw->has_sample;
    unsigned i;
    for (i = 0; i < HAPTICS_AXES && i < fw->identity.encoders; ++i) {
        const int32_t way = difference(fw->sample.count[i], fw->rest_count[i]);
        const uint32_t size = way < 0 ? (uint32_t)(-(way + 1)) + 1u : (uint32_t)way;
        moved = moved || size > fw->calibration.axis[i].counts_per_turn / REST_PART_OF_TURN;
    }
    if (moved) {
        for (i = 0; i < HAPTICS_AXES; ++i) {
            fw->rest_count[i] = fw->sample.count[i];
        }
        fw->rest_us = now_us;
    }
}

void haptics_firmware_sample(haptics_firmware* fw, const haptics_sample* sample, uint32_t now_us) {
    fw->sample = *sample;
    fw->driver_fault = fw->driver_fault || sample->driver_fault;
    watch_rest(fw, now_us);
    fw->has_sample = true;
    if (sample->absolute && !fw->homed) {
        memset(fw->zero, 0, sizeof fw->zero);
        fw->homed = true;
        fw->homings = (uint8_t)(fw->homings + 1u);
    }
    watch_time(fw, now_us);
}

static uint32_t status(const haptics_firmware* fw) {
    uint32_t bits = 0;
    bits |= fw->homed ? HAPTICS_STATUS_HOMED : 0u;
    bits |= fw->enabled ? HAPTICS_STATUS_ENABLED : 0u;
    bits |= fw->watchdog ? HAPTICS_STATUS_WATCHDOG : 0u;
    bits |= fw->sample.stop_pressed ? HAPTICS_STATUS_STOPPED : 0u;
    bits |= fw->driver_fault ? HAPTICS_STATUS_DRIVER_FAULT : 0u;
    bits |= fw->sample.hot ? HAPTICS_STATUS_HOT : 0u;
    bits |= fw->sample.force_valid ? HAPTICS_STATUS_HAND_FORCE : 0u;
    bits |= fw->sample.encoder_fault ? HAPTICS_STATUS_ENCODER_FAULT : 0u;
    bits |= fw->clamped ? HAPTICS_STATUS_CLAMPED : 0u;
    return bits;
}

void haptics_firmware_input(haptics_firmware* fw, uint32_t now_us, uint8_t report[HAPTICS_INPUT_SIZE]) {
    unsigned i;
    watch_time(fw, now_us);
    memset(report, 0, HAPTICS_INPUT_SIZE);
    report[HAPTICS_INPUT_AT_ID] = HAPTICS_INPUT_ID;
    report[HAPTICS_INPUT_AT_VERSION] = HAPTICS_PROTOCOL_VERSION;
    haptics_put_u16(report + HAPTICS_INPUT_AT_STATUS, status(fw));
    haptics_put_u32(report + HAPTICS_INPUT_AT_SEQUENCE, ++fw->input_sequence);
    haptics_put_u32(report + HAPTICS_INPUT_AT_TIME, now_us);
    for (i = 0; i < HAPTICS_AXES && i < fw->identity.encoders; ++i) {
        haptics_put_i32(report + HAPTICS_INPUT_AT_COUNT + 4u * i,
                        difference(fw->sample.count[i], fw->zero[i]));
    }
    for (i = 0; i < 3u && fw->sample.force_valid; ++i) {
        haptics_put_i32(report + HAPTICS_INPUT_AT_HAND_FORCE + 4u * i, fw->sample.hand_force[i]);
    }
    haptics_put_u32(report + HAPTICS_INPUT_AT_BUTTONS, fw->sample.buttons);
    haptics_put_u32(report + HAPTICS_INPUT_AT_COMMAND, fw->command_sequence);
    report[HAPTICS_INPUT_AT_HOMINGS] = fw->homings;
    report[HAPTICS_INPUT_AT_REFUSED] = fw->refused;
    haptics_seal(report, HAPTICS_INPUT_AT_CRC);
}

bool haptics_firmware_torques(haptics_firmware* fw, uint32_t now_us, int32_t torque_unm[HAPTICS_AXES]) {
    unsigned i;
    watch_time(fw, now_us);
    for (i = 0; i < HAPTICS_AXES; ++i) {
        torque_unm[i] = fw->enabled ? fw->torque_unm[i] : 0;
    }
    return fw->enabled;
}

int32_t haptics_firmware_current_ua(const haptics_firmware* fw, unsigned axis, int32_t torque_unm) {
    uint32_t constant;
    int64_t current;
    if (axis >= HAPTICS_AXES || fw->calibration.axis[axis].torque_constant_unm_per_a == 0u) {
        return 0;
    }
    constant = fw->calibration.axis[axis].torque_constant_unm_per_a;
    current = (int64_t)torque_unm * 1000000 / (int64_t)constant;
    if (current > 0x7FFFFFFF) {
        return 0x7FFFFFFF;
    }
    return current < -0x7FFFFFFF ? -0x7FFFFFFF : (int32_t)current;
}

static void put_identity(const haptics_identity* id, uint8_t* report) {
    report[HAPTICS_IDENTITY_AT_KIND] = id->kind;
    report[HAPTICS_IDENTITY_AT_ENCODERS] = id->encoders;
    report[HAPTICS_IDENTITY_AT_MOTORS] = id->motors;
    report[HAPTICS_IDENTITY_AT_CAPABILITIES] = id->capabilities;
    report[HAPTICS_IDENTITY_AT_FIRMWARE] = id->major;
    report[HAPTICS_IDENTITY_AT_FIRMWARE + 1u] = id->minor;
    memcpy(report + HAPTICS_IDENTITY_AT_SERIAL, id->serial, HAPTICS_SERIAL_SIZE);
    haptics_put_u32(report + HAPTICS_IDENTITY_AT_INTERVAL, id->interval_us);
    haptics_put_u32(report + HAPTICS_IDENTITY_AT_WATCHDOG, HAPTICS_WATCHDOG_US);
    haptics_seal(report, HAPTICS_IDENTITY_AT_CRC);
}

static void put_calibration(const haptics_calibration* c, uint8_t* report) {
    unsigned i;
    report[HAPTICS_CALIBRATION_AT_REVERSED] = c->reversed;
    for (i = 0; i < HAPTICS_AXES; ++i) {
        uint8_t* at = report + HAPTICS_CALIBRATION_AT_AXIS + HAPTICS_AXIS_SIZE * i;
        haptics_put_i32(at + HAPTICS_AXIS_AT_OFFSET, c->axis[i].offset_urad);
        haptics_put_u32(at + HAPTICS_AXIS_AT_COUNTS, c->axis[i].counts_per_turn);
        haptics_put_u32(at + HAPTICS_AXIS_AT_GEAR, c->axis[i].gear_millionths);
        haptics_put_u32(at + HAPTICS_AXIS_AT_TORQUE_CONSTANT, c->axis[i].torque_constant_unm_per_a);
        haptics_put_u32(at + HAPTICS_AXIS_AT_TORQUE_LIMIT, c->axis[i].torque_limit_unm);
    }
    for (i = 0; i < 3u; ++i) {
        haptics_put_i32(report + HAPTICS_CALIBRATION_AT_HOME + 4u * i, c->home[i]);
    }
    haptics_seal(report, HAPTICS_CALIBRATION_AT_CRC);
}

size_t haptics_firmware_get_feature(const haptics_firmware* fw, uint8_t id, uint8_t* report,
                                    size_t capacity) {
    const size_t size = id == HAPTICS_IDENTITY_ID      ? HAPTICS_IDENTITY_SIZE
                        : id == HAPTICS_CALIBRATION_ID ? HAPTICS_CALIBRATION_SIZE
                        : id == HAPTICS_ACTION_ID      ? HAPTICS_ACTION_SIZE
                                                       : 0u;
    if (size == 0u || capacity < size) {
        return 0;
    }
    memset(report, 0, size);
    report[0] = id;
    report[1] = HAPTICS_PROTOCOL_VERSION;
    if (id == HAPTICS_IDENTITY_ID) {
        put_identity(&fw->identity, report);
    } else if (id == HAPTICS_CALIBRATION_ID) {
        put_calibration(&fw->calibration, report);
    } else {
        report[HAPTICS_ACTION_AT_ACTION] = fw->action;
        report[HAPTICS_ACTION_AT_RESULT] = fw->result;
        haptics_seal(report, HAPTICS_ACTION_AT_CRC);
    }
    return size;
}

static bool home_here(haptics_firmware* fw, uint32_t now_us) {
    unsigned i;
    if (fw->enabled || !fw->has_sample || fw->sample.absolute || fw->sample.encoder_fault ||
        now_us - fw->rest_us < REST_US) {
        return false;
    }
    for (i = 0; i < HAPTICS_AXES; ++i) {
        fw->zero[i] = fw->sample.count[i];
    }
    fw->homed = true;
    fw->homings = (uint8_t)(fw->homings + 1u);
    return true;
}

haptics_verdict haptics_firmware_set_feature(haptics_firmware* fw, const uint8_t* report, size_t size,
                                             uint32_t now_us) {
    bool done = false;
    if (size != HAPTICS_ACTION_SIZE) {
        return HAPTICS_WRONG_SIZE;
    }
    if (report[HAPTICS_ACTION_AT_ID] != HAPTICS_ACTION_ID) {
        return HAPTICS_WRONG_ID;
    }
    if (!haptics_is_sealed(report, HAPTICS_ACTION_AT_CRC)) {
        return HAPTICS_WRONG_CRC;
    }
    if (report[HAPTICS_ACTION_AT_VERSION] != HAPTICS_PROTOCOL_VERSION) {
        return HAPTICS_WRONG_VERSION;
    }
    watch_time(fw, now_us);
    fw->action = report[HAPTICS_ACTION_AT_ACTION];
    if (fw->action == HAPTICS_ACTION_HOME_HERE) {
        done = home_here(fw, now_us);
    } else if (fw->action == HAPTICS_ACTION_CLEAR_FAULTS && !fw->enabled && !fw->sample.driver_fault) {
        fw->driver_fault = false;
        done = true;
    }
    fw->result = done ? HAPTICS_RESULT_DONE : HAPTICS_RESULT_REFUSED;
    return done ? HAPTICS_TAKEN : HAPTICS_REFUSED;
}
