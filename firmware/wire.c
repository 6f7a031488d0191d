#include "wire.h"

#include <haptics_firmware/firmware.h>

void haptics_put_u16(uint8_t* at, uint32_t value) {
    at[0] = (uint8_t)(value & 0xFFu);
    at[1] = (uint8_t)((value >> 8u) & 0xFFu);
}

void haptics_put_u32(uint8_t* at, uint32_t value) {
    haptics_put_u16(at, value & 0xFFFFu);
    haptics_put_u16(at + 2, value >> 16u);
}

void haptics_put_i32(uint8_t* at, int32_t value) {
    haptics_put_u32(at, (uint32_t)value);
}

uint32_t haptics_get_u16(const uint8_t* at) {
    return (uint32_t)at[0] | ((uint32_t)at[1] << 8u);
}

uint32_t haptics_get_u32(const uint8_t* at) {
    return haptics_get_u16(at) | (haptics_get_u16(at + 2) << 16u);
}

/* without the conversion of a large unsigned number, which C leaves to the compiler */
int32_t haptics_get_i32(const uint8_t* at) {
    const uint32_t bits = haptics_get_u32(at);
    if (bits <= 0x7FFFFFFFu) {
        return (int32_t)bits;
    }
    return -(int32_t)(0xFFFFFFFFu - bits) - 1;
}

/* four bits at a time: 64 bytes of table instead of 1024 */
uint32_t haptics_firmware_crc32(const uint8_t* bytes, size_t size) {
    static const uint32_t table[16] = {
        0x00000000u, 0x1DB71064u, 0x3B6E20C8u, 0x26D930ACu, 0x76DC4190u, 0x6B6B51F4u,
        0x4DB26158u, 0x5005713Cu, 0xEDB88320u, 0xF00F9344u, 0xD6D6A3E8u, 0xCB61B38Cu,
        0x9B64C2B0u, 0x86D3D2D4u, 0xA00AE278u, 0xBDBDF21Cu,
    };
    uint32_t crc = 0xFFFFFFFFu;
    size_t i;
    for (i = 0; i < size; ++i) {
        crc ^= bytes[i];
        crc = (crc >> 4u) ^ table[crc & 0xFu];
        crc = (crc >> 4u) ^ table[crc & 0xFu];
    }
    return crc ^ 0xFFFFFFFFu;
}

void haptics_seal(uint8_t* report, size_t crc_at) {
    haptics_put_u32(report + crc_at, haptics_firmware_crc32(report, crc_at));
}

bool haptics_is_sealed(const uint8_t* report, size_t crc_at) {
    return haptics_get_u32(report + crc_at) == haptics_firmware_crc32(report, crc_at);
}
