#include "tools/firmware/retained.h"

#include <stddef.h>
#include <string.h>

#include "tools/firmware/crc32.h"

static uint32_t Crc(const FwRetainedCopy* copy) {
  uint32_t crc = FwCrcAdd(FW_CRC_START, copy->turn);
  for (uint8_t i = 0; i < FW_SERVOS; ++i) {
    crc = FwCrcAdd(crc, (uint8_t)(copy->position[i] & 0xFFU));
    crc = FwCrcAdd(crc, (uint8_t)(copy->position[i] >> 8U));
  }
  return FwCrcValue(crc);
}

void FwRetain(FwRetained* retained, uint8_t turn, const uint16_t position[FW_SERVOS]) {
  FwRetainedCopy* copy = &retained->copies[turn & 1U];
  copy->turn = turn;
  memcpy(copy->position, position, sizeof copy->position);
  copy->crc = Crc(copy);
}

const uint16_t* FwRemember(const FwRetained* retained) {
  const FwRetainedCopy* a = &retained->copies[0];
  const FwRetainedCopy* b = &retained->copies[1];
  const bool a_sound = a->crc == Crc(a);
  const bool b_sound = b->crc == Crc(b);
  if (!a_sound && !b_sound) return NULL;
  if (!b_sound) return a->position;
  if (!a_sound) return b->position;
  return (int8_t)(a->turn - b->turn) > 0 ? a->position : b->position;
}
