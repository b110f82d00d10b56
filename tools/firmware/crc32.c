#include "tools/firmware/crc32.h"

// Bit by bit without a table: 64 bytes of memory are worth more here than the 10 us that a byte
// takes, of the 87 us until the next one comes at 115200 baud.
uint32_t FwCrcAdd(uint32_t crc_register, uint8_t byte) {
  crc_register ^= byte;
  for (uint8_t bit = 0; bit < 8; ++bit) {
    const uint8_t odd = (uint8_t)(crc_register & 1U);
    crc_register >>= 1U;
    if (odd) crc_register ^= UINT32_C(0xEDB88320);
  }
  return crc_register;
}
