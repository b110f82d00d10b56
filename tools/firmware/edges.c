#include "tools/firmware/edges.h"

#include <stdbool.h>

// Twelve starts 1450 us apart: the last pulse, 2500 us long and moved by less than 500 us, ends
// before the period does.
#define FIRST_START 400
#define START_SPACING 2900
#define PERIOD_END 39000

static bool IsFree(const FwEdge* edges, uint8_t count, uint16_t at) {
  for (uint8_t i = count; i > 0; --i) {  // the latest first: they are the likely ones
    const uint16_t other = edges[i - 1].at;
    if (at < other + FW_EDGE_GAP && other < at + FW_EDGE_GAP) return false;
  }
  return true;
}

static void Insert(FwEdge* edges, uint8_t count, FwEdge edge) {
  for (; count > 0 && edges[count - 1].at > edge.at; --count) edges[count] = edges[count - 1];
  edges[count] = edge;
}

void FwPlanEdges(const uint16_t width[FW_SERVOS], FwEdge edges[FW_MAX_EDGES]) {
  uint8_t count = 0;
  uint16_t base = FIRST_START;
  for (uint8_t servo = 0; servo < FW_SERVOS; ++servo, base += START_SPACING) {
    if (width[servo] == 0) continue;
    uint16_t start = base;
    while (!IsFree(edges, count, start) || !IsFree(edges, count, start + width[servo])) {
      start += FW_EDGE_GAP / 2;
    }
    Insert(edges, count++, (FwEdge){.at = start, .what = kFwRise | servo});
    Insert(edges, count++, (FwEdge){.at = start + width[servo], .what = servo});
  }
  edges[count] = (FwEdge){.at = PERIOD_END, .what = kFwPeriodEnd};
}
