#ifndef FACEWIRE_TOOLS_FIRMWARE_MESSAGE_H_
#define FACEWIRE_TOOLS_FIRMWARE_MESSAGE_H_

#include <stdbool.h>
#include <stdint.h>

// The messages of the native protocol (core/wire/README.md) that a receiver of servo pulses reads
// and writes. Pulse widths are in quarters of a microsecond.

#ifndef FW_SERVOS
#define FW_SERVOS 12  // that this receiver drives
#endif
#define FW_MIN_PULSE (4 * 500)
#define FW_MAX_PULSE (4 * 2500)

enum { kFwServoSetup = 0x14, kFwServoPulses = 0x15, kFwReceiverStatus = 0x81 };

typedef struct {
  uint16_t min;
  uint16_t neutral;
  uint16_t max;
  uint16_t speed;              // us/s
  uint16_t ramp_speed;         // us/s
  uint16_t ramp_acceleration;  // 10 us/s^2
} FwServo;

typedef struct {
  uint32_t id;  // 0: there is none
  uint32_t hold_ms;
  uint32_t ease_ms;
  uint32_t release_ms;
  uint8_t count;
  FwServo servos[FW_SERVOS];
} FwSetup;

typedef struct {
  uint32_t setup_id;
  bool stop;
  uint8_t count;
  uint16_t width[FW_SERVOS];  // 0: no pulse
} FwPulses;

// The longest payload that is read: that of a setup for all servos. A program that reads other
// messages, too, says what it keeps.
#ifndef FW_MAX_PAYLOAD_BYTES
#define FW_MAX_PAYLOAD_BYTES (17 + 12 * FW_SERVOS)
#endif

typedef enum {
  kFwOk,
  kFwMalformed,  // breaks a rule of the message
  kFwTooMany,    // a sound message for more servos than FW_SERVOS, as far as it was looked at
} FwReading;

// `payload` holds the first bytes of `size` (FwFrame). The output is written when kFwOk alone.
FwReading FwReadSetup(const uint8_t* payload, uint16_t size, FwSetup* setup);
FwReading FwReadPulses(const uint8_t* payload, uint16_t size, FwPulses* pulses);

typedef struct {
  uint32_t setup_id;
  uint8_t state;  // FwState
  uint8_t reset_causes;
  uint16_t supply_mv;
  uint32_t uptime_ms;
  uint32_t frames;
  uint32_t damaged;
  uint32_t lost;
  uint32_t refused;
  uint8_t count;
  uint16_t width[FW_SERVOS];
} FwStatus;

#define FW_VERSION_MAJOR 1
#define FW_VERSION_MINOR 0

// Header, payload and CRC are below 254 bytes: COBS adds one byte, and there are two delimiters.
#define FW_STATUS_FRAME_BYTES (4 + 32 + 2 * FW_SERVOS + 4 + 3)

// Writes the frame with both delimiters, FW_STATUS_FRAME_BYTES at most, and returns its size.
uint8_t FwWriteStatus(const FwStatus* status, uint16_t sequence, uint8_t* frame);

#endif  // FACEWIRE_TOOLS_FIRMWARE_MESSAGE_H_
