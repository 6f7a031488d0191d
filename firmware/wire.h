#ifndef HAPTICS_FIRMWARE_WIRE_H
#define HAPTICS_FIRMWARE_WIRE_H
/* Numbers in bytes, little-endian on every machine, and the seal at the end of a report. */

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

void haptics_put_u16(uint8_t* at, uint32_t value);
void haptics_put_u32(uint8_t* at, uint32_t value);
void haptics_put_i32(uint8_t* at, int32_t value);
uint32_t haptics_get_u16(const uint8_t* at);
uint32_t haptics_get_u32(const uint8_t* at);
int32_t haptics_get_i32(const uint8_t* at);

/* Writes the CRC of all bytes before `crc_at` there. */
void haptics_seal(uint8_t* report, size_t crc_at);
/* True when it is what haptics_seal would write. */
bool haptics_is_sealed(const uint8_t* report, size_t crc_at);

#endif
