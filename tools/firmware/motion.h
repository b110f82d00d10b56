#ifndef FACEWIRE_TOOLS_FIRMWARE_MOTION_H_
#define FACEWIRE_TOOLS_FIRMWARE_MOTION_H_

#include <stdbool.h>
#include <stdint.h>

#include "tools/firmware/message.h"

// How one servo's pulse width may change from one pulse to the next, in whole numbers. Positions
// are pulse widths in 1/256 us, speeds in that unit a tick.

#define FW_TICK_MS 20      // from pulse to pulse
#define FW_PER_QUARTER 64  // positions in a quarter of a microsecond

// What a setup says, in these units, so that no tick divides for it.
typedef struct {
  int32_t min;
  int32_t neutral;
  int32_t max;
  int32_t step;               // the most in a tick; each of these is rounded down
  int32_t ramp_step;          // the same in a ramp, no more than `step`
  int32_t ramp_acceleration;  // of a ramp's step from tick to tick, no more than ramp_step
} FwLimits;

typedef struct {
  int32_t position;
  int32_t eased_from;  // where an ease began
  int32_t velocity;    // of a ramp: what it moved in the last tick
  bool caught_up;      // a ramp reached what was asked for: from there on only the speed limits
} FwMotion;

static inline int32_t FwPosition(uint16_t quarter_us) {
  return (int32_t)quarter_us * FW_PER_QUARTER;
}

FwLimits FwLimitsOf(const FwServo* servo);

// Moves towards `goal` by the servo's speed at most.
void FwMotionFollow(FwMotion* motion, const FwLimits* limits, int32_t goal);

// Moves towards `goal` with the servo's ramp speed and acceleration, so that it stops there. A goal
// that moves on is caught up with; caught_up says when.
void FwMotionRamp(FwMotion* motion, const FwLimits* limits, int32_t goal);

// Moves from eased_from to `neutral`, smoothly, where it is at `elapsed_ms` of `ease_ms`; later if
// the servo's speed demands it.
void FwMotionEase(FwMotion* motion, const FwLimits* limits, uint32_t elapsed_ms, uint32_t ease_ms);

#endif  // FACEWIRE_TOOLS_FIRMWARE_MOTION_H_
