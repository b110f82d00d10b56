#ifndef FACEWIRE_TOOLS_FIRMWARE_EDGES_H_
#define FACEWIRE_TOOLS_FIRMWARE_EDGES_H_

#include <stdint.h>

#include "tools/firmware/message.h"

// The pulses of one period as a list of edges in the order of their times, for a timer that knows
// one time to come. Pulses start one after the other, so that the servos do not draw their current
// at once. A pulse's start may be anywhere, its width may not: so starts are moved a little where
// that keeps every two edges FW_EDGE_GAP apart, and each edge meets a processor that is free for
// it.

// Times are ticks of half a microsecond from the start of the period.
#define FW_PERIOD 40000
#define FW_EDGE_GAP 56

enum { kFwRise = 0x80, kFwPeriodEnd = 0x40 };  // or-ed to the index of the servo

typedef struct {
  uint16_t at;
  uint8_t what;  // index of the servo; kFwRise: its pulse starts, else it ends; or kFwPeriodEnd
} FwEdge;

#define FW_MAX_EDGES (2 * FW_SERVOS + 1)

// `width` in ticks, 0 for no pulse. The last edge of the list is kFwPeriodEnd, always.
void FwPlanEdges(const uint16_t width[FW_SERVOS], FwEdge edges[FW_MAX_EDGES]);

#endif  // FACEWIRE_TOOLS_FIRMWARE_EDGES_H_
