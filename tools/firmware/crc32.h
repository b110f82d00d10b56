#ifndef FACEWIRE_TOOLS_FIRMWARE_CRC32_H_
#define FACEWIRE_TOOLS_FIRMWARE_CRC32_H_

#include <stdint.h>

// CRC-32/ISO-HDLC (core/wire/README.md), one byte after the other.
#define FW_CRC_START UINT32_C(0xFFFFFFFF)
// What the register holds after bytes and their own CRC: so a receiver need not know where the
// bytes end before they do.
#define FW_CRC_SOUND UINT32_C(0xDEBB20E3)

uint32_t FwCrcAdd(uint32_t crc_register, uint8_t byte);
// The CRC of what was added.
static inline uint32_t FwCrcValue(uint32_t crc_register) { return ~crc_register; }

#endif  // FACEWIRE_TOOLS_FIRMWARE_CRC32_H_
