#ifndef HAPTICS_FIRMWARE_PROTOCOL_H
#define HAPTICS_FIRMWARE_PROTOCOL_H
/* The bytes between host and device: the one description that firmware and driver share. docs/hid-protocol.md
 * explains it. All numbers are little-endian; signed ones are two's complement. Every report ends with a
 * CRC-32 over all bytes before it, the report id included. Constants only, so that C and C++ read it alike.
 */

/* Grows when a report changes its meaning or size. */
#define HAPTICS_PROTOCOL_VERSION 1u

/* Vendor-defined usage of the top-level collection. */
#define HAPTICS_USAGE_PAGE 0xFF48u
#define HAPTICS_USAGE 0x01u

/* Axes that the reports have room for; a device uses the first few. */
#define HAPTICS_AXES 4u
#define HAPTICS_SERIAL_SIZE 16u

/* CRC-32/ISO-HDLC: polynomial 04C11DB7, reflected, start FFFFFFFF, final exclusive or FFFFFFFF. Its check
 * value, the CRC of the nine characters "123456789": */
#define HAPTICS_CRC_REFLECTED_POLYNOMIAL 0xEDB88320u
#define HAPTICS_CRC_CHECK 0xCBF43926u

/* The device lets its motors go when no valid command came for so long (us). */
#define HAPTICS_WATCHDOG_US 20000u

/* Report ids. */
#define HAPTICS_INPUT_ID 1u
#define HAPTICS_OUTPUT_ID 2u
#define HAPTICS_IDENTITY_ID 3u
#define HAPTICS_CALIBRATION_ID 4u
#define HAPTICS_ACTION_ID 5u

/* Input report, device to host, once a USB frame. */
#define HAPTICS_INPUT_AT_ID 0u
#define HAPTICS_INPUT_AT_VERSION 1u
#define HAPTICS_INPUT_AT_STATUS 2u      /* u16, HAPTICS_STATUS_* */
#define HAPTICS_INPUT_AT_SEQUENCE 4u    /* u32, one more in each report */
#define HAPTICS_INPUT_AT_TIME 8u        /* u32, us on the device's clock when the encoders were read, wraps */
#define HAPTICS_INPUT_AT_COUNT 12u      /* 4 x i32, encoder counts; 0 is the home pose */
#define HAPTICS_INPUT_AT_HAND_FORCE 28u /* 3 x i32, uN, uN, uN m: hand on handle, device frame */
#define HAPTICS_INPUT_AT_BUTTONS 40u    /* u32, bit i is button i */
#define HAPTICS_INPUT_AT_COMMAND 44u    /* u32, sequence of the last command taken */
#define HAPTICS_INPUT_AT_HOMINGS 48u    /* u8, times homed since power-on, wraps */
#define HAPTICS_INPUT_AT_REFUSED 49u    /* u8, commands refused since power-on, wraps */
#define HAPTICS_INPUT_AT_RESERVED 50u   /* u16, 0 */
#define HAPTICS_INPUT_AT_CRC 52u        /* u32 */
#define HAPTICS_INPUT_SIZE 56u

#define HAPTICS_STATUS_HOMED 0x0001u         /* counts mean what the calibration says */
#define HAPTICS_STATUS_ENABLED 0x0002u       /* the motors follow commands */
#define HAPTICS_STATUS_WATCHDOG 0x0004u      /* no command in time; cleared by a command without enable */
#define HAPTICS_STATUS_STOPPED 0x0008u       /* the device's own stop switch is pressed */
#define HAPTICS_STATUS_DRIVER_FAULT 0x0010u  /* a motor driver gave up */
#define HAPTICS_STATUS_HOT 0x0020u           /* too warm to drive */
#define HAPTICS_STATUS_HAND_FORCE 0x0040u    /* the hand force is measured */
#define HAPTICS_STATUS_ENCODER_FAULT 0x0080u /* an encoder reports an error of its own */
#define HAPTICS_STATUS_CLAMPED 0x0100u       /* the last command was cut to the torque limits */
#define HAPTICS_STATUS_KNOWN 0x01FFu

/* Output report, host to device. */
#define HAPTICS_OUTPUT_AT_ID 0u
#define HAPTICS_OUTPUT_AT_VERSION 1u
#define HAPTICS_OUTPUT_AT_FLAGS 2u    /* u16, HAPTICS_FLAG_* */
#define HAPTICS_OUTPUT_AT_SEQUENCE 4u /* u32, one more in each command */
#define HAPTICS_OUTPUT_AT_TORQUE 8u   /* 4 x i32, uN m at the motor shafts, counter-clockwise of the joint */
#define HAPTICS_OUTPUT_AT_INPUT 24u   /* u32, sequence of the input report this answers */
#define HAPTICS_OUTPUT_AT_CRC 28u
#define HAPTICS_OUTPUT_SIZE 32u

#define HAPTICS_FLAG_ENABLE 0x0001u

/* Identity, feature report, read only. */
#define HAPTICS_IDENTITY_AT_ID 0u
#define HAPTICS_IDENTITY_AT_VERSION 1u
#define HAPTICS_IDENTITY_AT_KIND 2u         /* u8, HAPTICS_KIND_* */
#define HAPTICS_IDENTITY_AT_ENCODERS 3u     /* u8 */
#define HAPTICS_IDENTITY_AT_MOTORS 4u       /* u8 */
#define HAPTICS_IDENTITY_AT_CAPABILITIES 5u /* u8, HAPTICS_CAN_* */
#define HAPTICS_IDENTITY_AT_FIRMWARE 6u     /* u8 major, u8 minor */
#define HAPTICS_IDENTITY_AT_SERIAL 8u       /* 16 ASCII characters, zeros after the end */
#define HAPTICS_IDENTITY_AT_INTERVAL 24u    /* u32, us between input reports */
#define HAPTICS_IDENTITY_AT_WATCHDOG 28u    /* u32, us */
#define HAPTICS_IDENTITY_AT_CRC 32u
#define HAPTICS_IDENTITY_SIZE 36u

#define HAPTICS_KIND_FIVE_BAR 1u      /* two encoders, two motors: x, y */
#define HAPTICS_KIND_TWIN_FIVE_BAR 2u /* four and four: x, y, theta */

#define HAPTICS_CAN_MEASURE_HAND_FORCE 0x01u
#define HAPTICS_CAN_HOME_ITSELF 0x02u /* absolute encoders or an index: homed without help */

/* Calibration, feature report, read only. */
#define HAPTICS_CALIBRATION_AT_ID 0u
#define HAPTICS_CALIBRATION_AT_VERSION 1u
#define HAPTICS_CALIBRATION_AT_REVERSED 2u /* u8, bit i: counts of axis i grow clockwise */
#define HAPTICS_CALIBRATION_AT_RESERVED 3u
#define HAPTICS_CALIBRATION_AT_AXIS 4u  /* 4 blocks of HAPTICS_AXIS_SIZE bytes */
#define HAPTICS_CALIBRATION_AT_HOME 84u /* 3 x i32, um, um, urad: handle pose at home, device frame */
#define HAPTICS_CALIBRATION_AT_CRC 96u
#define HAPTICS_CALIBRATION_SIZE 100u

/* One axis inside the calibration. */
#define HAPTICS_AXIS_AT_OFFSET 0u /* i32, urad: joint angle at count 0, counter-clockwise */
#define HAPTICS_AXIS_AT_COUNTS 4u /* u32, counts per turn of the motor shaft, all quadrature edges */
#define HAPTICS_AXIS_AT_GEAR 8u   /* u32, motor turns per million joint turns */
#define HAPTICS_AXIS_AT_TORQUE_CONSTANT 12u /* u32, uN m per A at the motor shaft */
#define HAPTICS_AXIS_AT_TORQUE_LIMIT 16u    /* u32, uN m at the motor shaft */
#define HAPTICS_AXIS_SIZE 20u

/* Action, feature report: written to ask, read to see how the last one went. */
#define HAPTICS_ACTION_AT_ID 0u
#define HAPTICS_ACTION_AT_VERSION 1u
#define HAPTICS_ACTION_AT_ACTION 2u /* u8, HAPTICS_ACTION_* */
#define HAPTICS_ACTION_AT_RESULT 3u /* u8, HAPTICS_RESULT_*; written as 0 */
#define HAPTICS_ACTION_AT_CRC 4u
#define HAPTICS_ACTION_SIZE 8u

#define HAPTICS_ACTION_NONE 0u
#define HAPTICS_ACTION_HOME_HERE 1u    /* the handle is in the home pose now: counts become 0 */
#define HAPTICS_ACTION_CLEAR_FAULTS 2u /* forget a driver fault that is over */

#define HAPTICS_RESULT_NONE 0u
#define HAPTICS_RESULT_DONE 1u
#define HAPTICS_RESULT_REFUSED 2u /* the motors were on, the handle moved, or the action is unknown */

/* The USB report descriptor that a board sends. Sizes leave out the id byte. */
#define HAPTICS_REPORT_DESCRIPTOR_SIZE 55u
#define HAPTICS_REPORT_DESCRIPTOR                                                                            \
    {                                                                                                        \
        0x06u, 0x48u, 0xFFu, /* usage page FF48 */                                                           \
        0x09u, 0x01u,        /* usage 1 */                                                                   \
        0xA1u, 0x01u,        /* collection (application) */                                                  \
        0x15u, 0x00u,        /*   logical minimum 0 */                                                       \
        0x26u, 0xFFu, 0x00u, /*   logical maximum 255 */                                                     \
        0x75u, 0x08u,        /*   report size 8 bits */                                                      \
        0x85u, 0x01u,        /*   report id 1 */                                                             \
        0x09u, 0x02u,        /*   usage 2 */                                                                 \
        0x95u, 0x37u,        /*   55 bytes */                                                                \
        0x81u, 0x02u,        /*   input (data, variable, absolute) */                                        \
        0x85u, 0x02u,        /*   report id 2 */                                                             \
        0x09u, 0x03u,        /*   usage 3 */                                                                 \
        0x95u, 0x1Fu,        /*   31 bytes */                                                                \
        0x91u, 0x02u,        /*   output */                                                                  \
        0x85u, 0x03u,        /*   report id 3 */                                                             \
        0x09u, 0x04u,        /*   usage 4 */                                                                 \
        0x95u, 0x23u,        /*   35 bytes */                                                                \
        0xB1u, 0x02u,        /*   feature */                                                                 \
        0x85u, 0x04u,        /*   report id 4 */                                                             \
        0x09u, 0x05u,        /*   usage 5 */                                                                 \
        0x95u, 0x63u,        /*   99 bytes */                                                                \
        0xB1u, 0x02u,        /*   feature */                                                                 \
        0x85u, 0x05u,        /*   report id 5 */                                                             \
        0x09u, 0x06u,        /*   usage 6 */                                                                 \
        0x95u, 0x07u,        /*   7 bytes */                                                                 \
        0xB1u, 0x02u,        /*   feature */                                                                 \
        0xC0u                /* end collection */                                                            \
    }

#endif
