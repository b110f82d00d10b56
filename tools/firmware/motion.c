#include "tools/firmware/motion.h"

#define PER_US (4 * FW_PER_QUARTER)
#define TICKS_PER_S (1000 / FW_TICK_MS)
#define CAUGHT_UP (2 * PER_US)  // no servo shows so small a step

static int32_t Limit(int32_t value, int32_t low, int32_t high) {
  return value < low ? low : value > high ? high : value;
}

static int32_t FloorDivide(int32_t value, int32_t by) {
  return value / by - (value % by < 0 ? 1 : 0);
}

FwLimits FwLimitsOf(const FwServo* servo) {
  const uint16_t ramp_speed = servo->ramp_speed < servo->speed ? servo->ramp_speed : servo->speed;
  FwLimits limits = {.min = FwPosition(servo->min),
                     .neutral = FwPosition(servo->neutral),
                     .max = FwPosition(servo->max),
                     .step = (int32_t)servo->speed * PER_US / TICKS_PER_S,
                     .ramp_step = (int32_t)ramp_speed * PER_US / TICKS_PER_S,
                     // 1 or more: the smallest is 10 us/s^2
                     .ramp_acceleration = (int32_t)servo->ramp_acceleration * (10 * PER_US) /
                                          (TICKS_PER_S * TICKS_PER_S)};
  if (limits.ramp_acceleration > limits.ramp_step) limits.ramp_acceleration = limits.ramp_step;
  return limits;
}

// Every motion ends here: whatever was computed, no position leaves min..max.
static void MoveTo(FwMotion* motion, const FwLimits* limits, int32_t position) {
  motion->position = Limit(position, limits->min, limits->max);
}

void FwMotionFollow(FwMotion* motion, const FwLimits* limits, int32_t goal) {
  const int32_t step = limits->step;
  motion->velocity = 0;
  MoveTo(motion, limits, Limit(goal, motion->position - step, motion->position + step));
}

// Whether a servo that moves n accelerations in this tick, and one less in each that follows, stops
// within `distance`: a (n + (n - 1) + ... + 1) = a n (n + 1) / 2 <= distance, written so that no
// product gets too long. Speeds are whole multiples of the
// acceleration for this, but for the last rest of a way.
static bool Stops(int32_t n, int32_t acceleration, int32_t distance) {
  return n <= 0 || n + 1 <= 2 * distance / (n * acceleration);
}

void FwMotionRamp(FwMotion* motion, const FwLimits* limits, int32_t goal) {
  const int32_t acceleration = limits->ramp_acceleration;
  const int32_t fastest = limits->ramp_step / acceleration;
  goal = Limit(goal, limits->min, limits->max);
  const int32_t way = goal - motion->position;
  const int32_t sign = way < 0 ? -1 : 1;
  const int32_t distance = sign * way;
  const int32_t velocity = sign * motion->velocity;  // below 0: away from the goal
  const int32_t before = FloorDivide(velocity, acceleration);
  int32_t n = Limit(before + 1, -fastest, fastest);
  // A goal that came nearer than the servo can stop is passed, not braked for beyond the limit.
  while (n >= before && !Stops(n, acceleration, distance)) --n;
  // The rest of the way is less than one step.
  const int32_t move = n == 0 ? Limit(distance, 0, velocity + acceleration) : n * acceleration;

  const int32_t position = motion->position + sign * move;
  MoveTo(motion, limits, position);
  motion->velocity = motion->position == position ? sign * move : 0;
  // Moving away from the goal means that the goal came across: the servo is where it shall be.
  const int32_t left = goal - motion->position;
  motion->caught_up = velocity < 0 || (left >= -CAUGHT_UP && left <= CAUGHT_UP);
}

void FwMotionEase(FwMotion* motion, const FwLimits* limits, uint32_t elapsed_ms, uint32_t ease_ms) {
  const int32_t neutral = limits->neutral;
  int32_t goal = neutral;
  if (elapsed_ms < ease_ms) {
    // u from 0 to 4096, and 3 u^2 - 2 u^3: at rest at both ends.
    while (ease_ms > 0xFFFFF) {
      ease_ms >>= 1U;
      elapsed_ms >>= 1U;
    }
    const uint32_t u = elapsed_ms * 4096U / ease_ms;
    const uint32_t smooth = ((u * u) >> 12U) * (3 * 4096U - 2 * u) >> 12U;
    // At most 2000 us * 256 * 4096, which just fits.
    goal = motion->eased_from + (neutral - motion->eased_from) * (int32_t)smooth / 4096;
  }
  FwMotionFollow(motion, limits, goal);
}
