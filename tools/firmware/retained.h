#ifndef FACEWIRE_TOOLS_FIRMWARE_RETAINED_H_
#define FACEWIRE_TOOLS_FIRMWARE_RETAINED_H_

#include <stdbool.h>
#include <stdint.h>

#include "tools/firmware/message.h"

// Where the servos were, in memory that a reset leaves alone and that is random after a power-on:
// the watchdog, or somebody who opens a serial port whose line resets the board, must not make the
// head jump to neutral. Two copies, so that a reset in the middle of writing one leaves the other.
typedef struct {
  uint16_t position[FW_SERVOS];  // quarters of a microsecond, 0 for unknown
  uint8_t turn;                  // counts the writings
  uint32_t crc;
} FwRetainedCopy;

typedef struct {
  FwRetainedCopy copies[2];
} FwRetained;

// `turn` of each call is one more than of the last.
void FwRetain(FwRetained* retained, uint8_t turn, const uint16_t position[FW_SERVOS]);
// The last positions that were retained; null when there are none.
const uint16_t* FwRemember(const FwRetained* retained);

#endif  // FACEWIRE_TOOLS_FIRMWARE_RETAINED_H_
