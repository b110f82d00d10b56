#include "tools/firmware/message.h"

#include <stddef.h>

#include "tools/firmware/bytes.h"
#include "tools/firmware/crc32.h"

#define MOST_SERVOS 64  // in a message
#define SETUP_BYTES 17
#define SERVO_BYTES 12
#define PULSES_BYTES 6

static bool IsPulse(uint16_t width) { return width >= FW_MIN_PULSE && width <= FW_MAX_PULSE; }

static FwServo ReadServo(const uint8_t* payload, uint8_t index) {
  const uint8_t* const bytes = payload + SETUP_BYTES + (size_t)SERVO_BYTES * index;
  return (FwServo){.min = FwGet16(bytes),
                   .neutral = FwGet16(bytes + 2),
                   .max = FwGet16(bytes + 4),
                   .speed = FwGet16(bytes + 6),
                   .ramp_speed = FwGet16(bytes + 8),
                   .ramp_acceleration = FwGet16(bytes + 10)};
}

static bool IsValid(const FwServo* servo) {
  return IsPulse(servo->min) && IsPulse(servo->max) && servo->min <= servo->neutral &&
         servo->neutral <= servo->max && servo->speed > 0 && servo->ramp_speed > 0 &&
         servo->ramp_acceleration > 0;
}

FwReading FwReadSetup(const uint8_t* payload, uint16_t size, FwSetup* setup) {
  if (size < SETUP_BYTES) return kFwMalformed;
  const uint8_t count = payload[16];
  if (FwGet32(payload) == 0 || count > MOST_SERVOS ||
      size < SETUP_BYTES + SERVO_BYTES * (uint16_t)count) {
    return kFwMalformed;
  }
  for (uint8_t i = 0; i < count && i < FW_SERVOS; ++i) {
    const FwServo servo = ReadServo(payload, i);
    if (!IsValid(&servo)) return kFwMalformed;
  }
  if (count > FW_SERVOS) return kFwTooMany;

  setup->id = FwGet32(payload);
  setup->hold_ms = FwGet32(payload + 4);
  setup->ease_ms = FwGet32(payload + 8);
  setup->release_ms = FwGet32(payload + 12);
  setup->count = count;
  for (uint8_t i = 0; i < count; ++i) {
    setup->servos[i] = ReadServo(payload, i);
  }
  return kFwOk;
}

static uint16_t ReadPulse(const uint8_t* payload, uint8_t index) {
  return FwGet16(payload + PULSES_BYTES + (size_t)2 * index);
}

FwReading FwReadPulses(const uint8_t* payload, uint16_t size, FwPulses* pulses) {
  if (size < PULSES_BYTES) return kFwMalformed;
  const uint8_t count = payload[5];
  if (count > MOST_SERVOS || size < PULSES_BYTES + 2 * (uint16_t)count) return kFwMalformed;
  for (uint8_t i = 0; i < count; ++i) {
    const uint16_t width = ReadPulse(payload, i);
    if (width != 0 && !IsPulse(width)) return kFwMalformed;
  }
  if (count > FW_SERVOS) return kFwTooMany;

  pulses->setup_id = FwGet32(payload);
  pulses->stop = (payload[4] & 1U) != 0;
  pulses->count = count;
  for (uint8_t i = 0; i < count; ++i) {
    pulses->width[i] = ReadPulse(payload, i);
  }
  return kFwOk;
}

// A frame in the making. No block of COBS can get as long as 254 bytes here, so each one ends with
// a zero, or with the frame.
typedef struct {
  uint8_t* bytes;
  uint8_t size;
  uint8_t code_at;  // where the length of the present block goes
  uint32_t crc;
} Writer;

static void Put8(Writer* w, uint8_t byte) {
  w->crc = FwCrcAdd(w->crc, byte);
  if (byte == 0) {
    w->bytes[w->code_at] = (uint8_t)(w->size - w->code_at);
    w->code_at = w->size;
  }
  w->bytes[w->size++] = byte;
}

static void Put16(Writer* w, uint16_t value) {
  Put8(w, (uint8_t)(value & 0xFFU));
  Put8(w, (uint8_t)(value >> 8U));
}

static void Put32(Writer* w, uint32_t value) {
  Put16(w, (uint16_t)(value & 0xFFFFU));
  Put16(w, (uint16_t)(value >> 16U));
}

uint8_t FwWriteStatus(const FwStatus* status, uint16_t sequence, uint8_t* frame) {
  Writer w = {.bytes = frame, .size = 2, .code_at = 1, .crc = FW_CRC_START};
  frame[0] = 0;
  Put8(&w, 1);  // version of the protocol
  Put8(&w, kFwReceiverStatus);
  Put16(&w, sequence);
  Put32(&w, status->setup_id);
  Put8(&w, status->state);
  Put8(&w, FW_SERVOS);
  Put8(&w, FW_VERSION_MAJOR);
  Put8(&w, FW_VERSION_MINOR);
  Put8(&w, status->reset_causes);
  Put16(&w, status->supply_mv);
  Put32(&w, status->uptime_ms);
  Put32(&w, status->frames);
  Put32(&w, status->damaged);
  Put32(&w, status->lost);
  Put32(&w, status->refused);
  Put8(&w, status->count);
  for (uint8_t i = 0; i < status->count; ++i) Put16(&w, status->width[i]);
  Put32(&w, FwCrcValue(w.crc));
  w.bytes[w.code_at] = (uint8_t)(w.size - w.code_at);
  w.bytes[w.size++] = 0;
  return w.size;
}
