#include "tools/firmware/receiver.h"

#include <stddef.h>
#include <string.h>

// Frames may be late for so long before the servos are held: ten a second are enough.
#define LATE_MS 100
#define STATUS_TICKS (1000 / FW_TICK_MS)
#define REPORT_TICKS (200 / FW_TICK_MS)  // between two answers to frames that were refused

void FwReceiverInit(FwReceiver* receiver, const uint16_t* remembered) {
  memset(receiver, 0, sizeof *receiver);
  receiver->since_status = STATUS_TICKS;
  for (uint8_t i = 0; remembered != NULL && i < FW_SERVOS; ++i) {
    receiver->known[i] = remembered[i] != 0;
    receiver->motion[i].position = FwPosition(remembered[i]);
  }
}

static void Enter(FwReceiver* receiver, FwState state) {
  if (receiver->state == state) return;
  receiver->state = state;
  receiver->report = true;
}

static void Release(FwReceiver* receiver) {
  memset(receiver->on, 0, sizeof receiver->on);
  Enter(receiver, kFwReleased);
}

// A servo is believed to be where it was last, and without a past at its neutral, where the
// failsafe leaves it; in any case within its limits.
static void TakeSetup(FwReceiver* receiver, const FwSetup* setup) {
  receiver->setup = *setup;
  receiver->fresh = false;
  for (uint8_t i = 0; i < setup->count; ++i) {
    FwLimits* limits = &receiver->limits[i];
    FwMotion* motion = &receiver->motion[i];
    *limits = FwLimitsOf(&setup->servos[i]);
    if (!receiver->known[i]) motion->position = limits->neutral;
    receiver->known[i] = true;
    FwMotionFollow(motion, limits, motion->position);  // into the limits
  }
  receiver->state = kFwWaiting;
  Release(receiver);
}

static void TakePulses(FwReceiver* receiver, const FwPulses* pulses) {
  memcpy(receiver->wish, pulses->width, sizeof receiver->wish);
  receiver->stop = pulses->stop;
  receiver->fresh = true;
}

void FwReceiverTake(FwReceiver* receiver, const FwFrame* frame) {
  bool refused = false;
  if (frame->type == kFwServoSetup) {
    FwSetup setup;
    const FwReading reading = FwReadSetup(frame->payload, frame->size, &setup);
    refused = reading == kFwTooMany;
    if (reading == kFwOk && setup.id != receiver->setup.id) TakeSetup(receiver, &setup);
  } else if (frame->type == kFwServoPulses) {
    FwPulses pulses = {.count = 0};
    const FwReading reading = FwReadPulses(frame->payload, frame->size, &pulses);
    const bool ours = reading == kFwOk && receiver->setup.id != 0 &&
                      pulses.setup_id == receiver->setup.id &&
                      pulses.count == receiver->setup.count;
    refused = reading != kFwMalformed && !ours;
    if (ours) TakePulses(receiver, &pulses);
  }
  if (refused) {
    ++receiver->refused;
    if (receiver->since_status >= REPORT_TICKS) receiver->report = true;
  }
}

static void Crawl(FwReceiver* receiver) {
  for (uint8_t i = 0; i < FW_SERVOS; ++i) {
    receiver->motion[i].caught_up = false;
    receiver->motion[i].velocity = 0;
  }
}

// A width of 0 ends a servo's pulses at once; with the first other one it starts to crawl, unless
// there is a stop.
static void SwitchServos(FwReceiver* receiver) {
  for (uint8_t i = 0; i < receiver->setup.count; ++i) {
    const bool on = receiver->wish[i] != 0 && (receiver->on[i] || !receiver->stop);
    if (on && !receiver->on[i]) {
      receiver->motion[i].caught_up = false;
      receiver->motion[i].velocity = 0;
    }
    receiver->on[i] = on;
  }
}

static void Follow(FwReceiver* receiver) {
  bool ramping = false;
  for (uint8_t i = 0; i < receiver->setup.count; ++i) {
    if (!receiver->on[i]) continue;
    FwMotion* motion = &receiver->motion[i];
    const int32_t goal = FwPosition(receiver->wish[i]);
    if (motion->caught_up) {
      FwMotionFollow(motion, &receiver->limits[i], goal);
    } else {
      FwMotionRamp(motion, &receiver->limits[i], goal);
      ramping = true;
    }
  }
  Enter(receiver, ramping ? kFwRamping : kFwFollowing);
}

static void Ease(FwReceiver* receiver, uint32_t elapsed_ms) {
  const bool begins = receiver->state != kFwEasing && receiver->state != kFwResting;
  const uint32_t ease_ms = receiver->setup.ease_ms;
  for (uint8_t i = 0; i < receiver->setup.count; ++i) {
    FwMotion* motion = &receiver->motion[i];
    if (begins) motion->eased_from = motion->position;
    if (receiver->on[i]) FwMotionEase(motion, &receiver->limits[i], elapsed_ms, ease_ms);
  }
  Enter(receiver, elapsed_ms < ease_ms ? kFwEasing : kFwResting);
}

void FwReceiverTick(FwReceiver* receiver) {
  ++receiver->ticks;
  if (receiver->since_status < UINT8_MAX) ++receiver->since_status;
  if (receiver->fresh) {
    receiver->fresh = false;
    receiver->silence_ms = 0;
    SwitchServos(receiver);
    if (receiver->state != kFwRamping && receiver->state != kFwFollowing) Crawl(receiver);
    if (receiver->stop) {
      Enter(receiver, kFwStopped);
    } else {
      Follow(receiver);
    }
    return;
  }
  if (receiver->state == kFwWaiting || receiver->state == kFwReleased) return;

  if (receiver->silence_ms < UINT32_MAX - FW_TICK_MS) receiver->silence_ms += FW_TICK_MS;
  // What is left of the silence behind each of the contract's times.
  const FwSetup* contract = &receiver->setup;
  const bool held = receiver->silence_ms < contract->hold_ms;
  const uint32_t easing_ms = receiver->silence_ms - contract->hold_ms;
  const bool eased = held || easing_ms < contract->ease_ms;
  const uint32_t resting_ms = easing_ms - contract->ease_ms;
  if (!eased && resting_ms >= contract->release_ms) {
    Release(receiver);
  } else if (receiver->stop) {
    return;
  } else if (!held) {
    Ease(receiver, easing_ms);
  } else if (receiver->silence_ms < LATE_MS) {
    Follow(receiver);
  } else {
    Enter(receiver, kFwHolding);
  }
}

uint16_t FwReceiverPulse(const FwReceiver* receiver, uint8_t servo) {
  if (!receiver->on[servo]) return 0;
  // To the nearest, up from the middle: no position is below min, so no pulse is; max needs a look.
  const uint16_t half_us =
      (uint16_t)((receiver->motion[servo].position + FW_PER_QUARTER) / (2 * FW_PER_QUARTER));
  const uint16_t most = receiver->setup.servos[servo].max / 2;
  return half_us < most ? half_us : most;
}

uint16_t FwReceiverPosition(const FwReceiver* receiver, uint8_t servo) {
  if (!receiver->known[servo]) return 0;
  return (uint16_t)(receiver->motion[servo].position / FW_PER_QUARTER);
}

bool FwReceiverStatusDue(const FwReceiver* receiver) {
  return receiver->report || receiver->since_status >= STATUS_TICKS;
}

uint8_t FwReceiverWriteStatus(FwReceiver* receiver, const FwLinkStats* link, uint8_t reset_causes,
                              uint16_t supply_mv, uint8_t* frame) {
  FwStatus status = {.setup_id = receiver->setup.id,
                     .state = (uint8_t)receiver->state,
                     .reset_causes = reset_causes,
                     .supply_mv = supply_mv,
                     .uptime_ms = receiver->ticks * FW_TICK_MS,
                     .frames = link->sound,
                     .damaged = FwDamaged(link),
                     .lost = link->lost,
                     .refused = receiver->refused,
                     .count = receiver->setup.count};
  for (uint8_t i = 0; i < status.count; ++i) {
    status.width[i] = receiver->on[i] ? FwReceiverPosition(receiver, i) : 0;
  }
  const uint16_t sequence = receiver->sequence;
  receiver->sequence = sequence == 0xFFFF ? 1 : (uint16_t)(sequence + 1U);
  receiver->since_status = 0;
  receiver->report = false;
  return FwWriteStatus(&status, sequence, frame);
}
