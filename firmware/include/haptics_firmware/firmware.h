#ifndef HAPTICS_FIRMWARE_FIRMWARE_H
#define HAPTICS_FIRMWARE_FIRMWARE_H
/* What a haptic device does with the reports of protocol.h: a state machine in integers. It allocates
 * nothing, calls nothing but memcpy and memset, knows no clock, no USB and no operating system; README.md
 * says what a board adds. Not re-entrant: call it from one context, or keep interrupts out while it runs. */

#include <haptics_firmware/protocol.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* What the device is. */
typedef struct {
    uint8_t kind;         /* HAPTICS_KIND_* */
    uint8_t encoders;     /* 1 to HAPTICS_AXES */
    uint8_t motors;       /* 1 to HAPTICS_AXES */
    uint8_t capabilities; /* HAPTICS_CAN_* */
    uint8_t major;        /* version of the firmware */
    uint8_t minor;
    char serial[HAPTICS_SERIAL_SIZE]; /* ASCII, zeros after the end */
    uint32_t interval_us;             /* between input reports: 1000 on USB full speed */
} haptics_identity;

/* One axis; see HAPTICS_AXIS_AT_*. */
typedef struct {
    int32_t offset_urad;
    uint32_t counts_per_turn;
    uint32_t gear_millionths;
    uint32_t torque_constant_unm_per_a;
    uint32_t torque_limit_unm;
} haptics_axis;

/* What the counts and torques mean. */
typedef struct {
    uint8_t reversed; /* bit i: counts of axis i grow clockwise */
    haptics_axis axis[HAPTICS_AXES];
    int32_t home[3]; /* um, um, urad */
} haptics_calibration;

/* What the board measured. */
typedef struct {
    int32_t count[HAPTICS_AXES]; /* raw counts since power-on, any zero; may wrap */
    int32_t hand_force[3];       /* uN, uN, uN m; used when force_valid */
    uint32_t buttons;            /* bit i is button i */
    bool force_valid;
    bool absolute;      /* the counts already mean what the calibration says */
    bool stop_pressed;  /* motors stay off while it is */
    bool driver_fault;  /* latched here until HAPTICS_ACTION_CLEAR_FAULTS */
    bool hot;           /* motors stay off while it is */
    bool encoder_fault; /* motors stay off while it is */
} haptics_sample;

/* What became of a command or an action. */
typedef enum {
    HAPTICS_TAKEN,
    HAPTICS_WRONG_SIZE,
    HAPTICS_WRONG_ID,
    HAPTICS_WRONG_VERSION,
    HAPTICS_WRONG_CRC,
    HAPTICS_OLD_SEQUENCE, /* repeated, or out of order */
    HAPTICS_REFUSED       /* an action that cannot be done now */
} haptics_verdict;

/* The whole state. Fields are for the functions below. */
typedef struct {
    haptics_identity identity;
    haptics_calibration calibration;
    /* command */
    int32_t torque_unm[HAPTICS_AXES];
    uint32_t command_sequence;
    uint32_t command_us;
    bool has_command;
    bool enabled;
    bool watchdog;
    bool tripped; /* let go for a reason; a command without enable clears it */
    bool clamped;
    uint8_t refused;
    /* measured */
    haptics_sample sample;
    int32_t zero[HAPTICS_AXES];
    int32_t rest_count[HAPTICS_AXES];
    uint32_t rest_us;
    bool has_sample;
    bool homed;
    bool driver_fault;
    uint8_t homings;
    /* reports and actions */
    uint32_t input_sequence;
    uint8_t action;
    uint8_t result;
} haptics_firmware;

/* Power-on: motors off, watchdog set, not homed. now_us: the board's clock, here and below; it may wrap. */
void haptics_firmware_init(haptics_firmware* fw, const haptics_identity* identity,
                           const haptics_calibration* calibration, uint32_t now_us);

/* The host wrote an output report. Whatever is not HAPTICS_TAKEN changes no torque and does not feed the
 * watchdog. */
haptics_verdict haptics_firmware_command(haptics_firmware* fw, const uint8_t* report, size_t size,
                                         uint32_t now_us);

/* The encoders were read. Once per input report, and as often besides as the board likes. */
void haptics_firmware_sample(haptics_firmware* fw, const haptics_sample* sample, uint32_t now_us);

/* Fills the next input report. */
void haptics_firmware_input(haptics_firmware* fw, uint32_t now_us, uint8_t report[HAPTICS_INPUT_SIZE]);

/* Torques for the motor shafts (uN m), within limits; false, and all zero, when the motors are to be let go.
 * Call it at least every millisecond: it is also what watches the time. */
bool haptics_firmware_torques(haptics_firmware* fw, uint32_t now_us, int32_t torque_unm[HAPTICS_AXES]);

/* Current for a torque of an axis, uA; 0 for an axis without a torque constant. */
int32_t haptics_firmware_current_ua(const haptics_firmware* fw, unsigned axis, int32_t torque_unm);

/* The host reads a feature report: fills up to `capacity` bytes, returns how many, 0 for an unknown id. */
size_t haptics_firmware_get_feature(const haptics_firmware* fw, uint8_t id, uint8_t* report, size_t capacity);

/* The host wrote a feature report. */
haptics_verdict haptics_firmware_set_feature(haptics_firmware* fw, const uint8_t* report, size_t size,
                                             uint32_t now_us);

/* CRC-32/ISO-HDLC of `size` bytes; 0 bytes give 0. */
uint32_t haptics_firmware_crc32(const uint8_t* bytes, size_t size);

#ifdef __cplusplus
}
#endif

#endif
