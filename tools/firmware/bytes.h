#ifndef FACEWIRE_TOOLS_FIRMWARE_BYTES_H_
#define FACEWIRE_TOOLS_FIRMWARE_BYTES_H_

#include <stdint.h>

// Little-endian numbers from bytes, wherever they lie.
static inline uint16_t FwGet16(const uint8_t* bytes) {
  return (uint16_t)(bytes[0] | (uint16_t)((uint16_t)bytes[1] << 8U));
}
static inline uint32_t FwGet32(const uint8_t* bytes) {
  return FwGet16(bytes) | ((uint32_t)FwGet16(bytes + 2) << 16U);
}

#endif  // FACEWIRE_TOOLS_FIRMWARE_BYTES_H_
