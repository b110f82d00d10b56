#ifndef FACEWIRE_TOOLS_FIRMWARE_RECEIVER_H_
#define FACEWIRE_TOOLS_FIRMWARE_RECEIVER_H_

#include <stdbool.h>
#include <stdint.h>

#include "tools/firmware/decoder.h"
#include "tools/firmware/message.h"
#include "tools/firmware/motion.h"

// What the receiver does: takes frames as they come, and once a tick (FW_TICK_MS) decides where
// every servo is. Its only clock is the tick. The rules: core/wire/README.md, Receivers of servo
// pulses.

// The numbers are those of the wire.
typedef enum {
  kFwWaiting = 0,
  kFwRamping = 1,
  kFwFollowing = 2,
  kFwHolding = 3,
  kFwEasing = 4,
  kFwResting = 5,
  kFwReleased = 6,
  kFwStopped = 7,
} FwState;

typedef struct {
  FwSetup setup;
  FwState state;
  bool known[FW_SERVOS];       // the servo's position is not a guess
  bool on[FW_SERVOS];          // it gets pulses
  FwLimits limits[FW_SERVOS];  // of the setup
  FwMotion motion[FW_SERVOS];
  uint16_t wish[FW_SERVOS];  // of the last pulses that were obeyed; 0 for none
  bool stop;
  bool fresh;           // pulses came since the last tick
  uint32_t silence_ms;  // since the last pulses
  uint32_t ticks;       // since the start
  uint32_t refused;
  uint16_t sequence;     // of the next status
  uint8_t since_status;  // ticks
  bool report;           // something happened that the device should know
} FwReceiver;

// `remembered`: where the servos were before a reset, quarters of a microsecond, 0 for unknown; or
// null.
void FwReceiverInit(FwReceiver* receiver, const uint16_t* remembered);
void FwReceiverTake(FwReceiver* receiver, const FwFrame* frame);
void FwReceiverTick(FwReceiver* receiver);

// The pulse of a servo in half microseconds, 0 for none. Rounded to within its limits.
uint16_t FwReceiverPulse(const FwReceiver* receiver, uint8_t servo);
// Where a servo is, pulse or not, in quarters of a microsecond; 0 for unknown. To be remembered.
uint16_t FwReceiverPosition(const FwReceiver* receiver, uint8_t servo);

// Whether a status is due; writing one (FW_STATUS_FRAME_BYTES at most) ends that.
bool FwReceiverStatusDue(const FwReceiver* receiver);
uint8_t FwReceiverWriteStatus(FwReceiver* receiver, const FwLinkStats* link, uint8_t reset_causes,
                              uint16_t supply_mv, uint8_t* frame);

#endif  // FACEWIRE_TOOLS_FIRMWARE_RECEIVER_H_
