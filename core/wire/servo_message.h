#ifndef FACEWIRE_CORE_WIRE_SERVO_MESSAGE_H_
#define FACEWIRE_CORE_WIRE_SERVO_MESSAGE_H_

#include <cstddef>
#include <cstdint>

#include "core/base/capacity.h"
#include "core/base/inline_vector.h"

// What the device and a receiver of servo pulses (tools/firmware) say to each other; part of
// core/wire/message.h. Their bytes: core/wire/README.md. Pulse widths are in quarters of a
// microsecond: 6000 is 1500 us.
namespace facewire::wire {

// No receiver makes a pulse outside these, whatever its setup says.
inline constexpr std::uint16_t kMinPulseQuarterUs = 4 * 500;
inline constexpr std::uint16_t kMaxPulseQuarterUs = 4 * 2500;

// What a receiver keeps one servo to. kMinPulse.. <= min <= neutral <= max <= kMaxPulse..
struct ServoLimits {
  std::uint16_t min_quarter_us = 4 * 1000;
  std::uint16_t neutral_quarter_us = 4 * 1500;
  std::uint16_t max_quarter_us = 4 * 2000;
  // us of pulse width a second; never faster, whatever is asked for. 1 or more.
  std::uint16_t speed_us_s = 6000;
  // The crawl from wherever the servo was to what is asked for, whenever its pulses (re)start: us/s
  // and units of 10 us/s^2. 1 or more.
  std::uint16_t ramp_speed_us_s = 200;
  std::uint16_t ramp_acceleration_10us_s2 = 40;
};

constexpr bool IsPulse(std::uint16_t quarter_us) noexcept {
  return quarter_us >= kMinPulseQuarterUs && quarter_us <= kMaxPulseQuarterUs;
}
constexpr bool IsPulseOrNone(std::uint16_t quarter_us) noexcept {
  return quarter_us == 0 || IsPulse(quarter_us);
}
constexpr bool IsValid(const ServoLimits& servo) noexcept {
  return IsPulse(servo.min_quarter_us) && IsPulse(servo.max_quarter_us) &&
         servo.min_quarter_us <= servo.neutral_quarter_us &&
         servo.neutral_quarter_us <= servo.max_quarter_us && servo.speed_us_s > 0 &&
         servo.ramp_speed_us_s > 0 && servo.ramp_acceleration_10us_s2 > 0;
}

// Everything that a receiver must know before it may move a servo, and its failsafe contract: when
// no sound ServoPulses arrive, the pulses hold for hold_ms, go to neutral within ease_ms, stay
// there for release_ms, and end (torque off).
struct ServoSetup {
  std::uint32_t setup_id = 1;  // names this setup: another one has another id; not 0
  std::uint32_t hold_ms = 400;
  std::uint32_t ease_ms = 1500;
  std::uint32_t release_ms = 60'000;
  InlineVector<ServoLimits, kMaxServos> servos{};
};

// Where the servos shall be now. A receiver obeys it only when setup_id and the count are those of
// its setup.
struct ServoPulses {
  std::uint32_t setup_id = 1;
  // Emergency stop: every pulse keeps its present width, whatever quarter_us says, until a message
  // without it arrives; a width of 0 still ends a servo's pulses.
  bool stop = false;
  InlineVector<std::uint16_t, kMaxServos> quarter_us{};  // 0: no pulses, the servo goes limp
};

// The numbers are those of the wire: append only.
enum class ReceiverState : std::uint8_t {
  kWaiting = 0,    // no setup: no pulses
  kRamping = 1,    // crawling from where the servos were to what is asked for
  kFollowing = 2,  // pulses are those asked for, within the limits
  kHolding = 3,    // no messages: the pulses stay as they were
  kEasing = 4,     // to neutral
  kResting = 5,    // neutral
  kReleased = 6,   // no pulses, until the next ServoPulses
  kStopped = 7,    // emergency stop
};

// Why a receiver started, as far as it can tell: bits of ReceiverStatus::reset_causes.
enum ReceiverReset : std::uint8_t {
  kResetPowerOn = 1,
  kResetExternal = 2,  // its reset pin: on many boards, somebody opened the serial port
  kResetBrownOut = 4,  // the supply sagged
  kResetWatchdog = 8,
};

// From the receiver, once a second and at every change of state. Counters wrap at 2^32. Whenever
// setup_id is not the device's own, the device sends its ServoSetup.
struct ReceiverStatus {
  std::uint32_t setup_id = 0;                     // 0: none
  ReceiverState state = ReceiverState::kWaiting;  // a state of a later sender arrives as kWaiting
  std::uint8_t capacity = 0;                      // how many servos it can drive, 0..kMaxServos
  std::uint8_t version_major = 0;                 // of its firmware
  std::uint8_t version_minor = 0;
  std::uint8_t reset_causes = 0;  // ReceiverReset; 0: it cannot tell
  std::uint16_t supply_mv = 0;    // of its own processor; 0: it cannot tell
  std::uint32_t uptime_ms = 0;
  std::uint32_t frames = 0;   // sound frames received, of any type
  std::uint32_t damaged = 0;  // pieces dropped for damage
  std::uint32_t lost = 0;  // frames that never came or came damaged, from the gaps in the numbers
  std::uint32_t refused = 0;  // ServoPulses of another setup, setups it cannot drive
  InlineVector<std::uint16_t, kMaxServos> quarter_us{};  // present pulses; 0: none
};

const char* Name(ReceiverState state) noexcept;  // "following"

constexpr std::size_t ServoSetupPayloadBytes(std::size_t servos) noexcept {
  return 17 + 12 * servos;
}
constexpr std::size_t ServoPulsesPayloadBytes(std::size_t servos) noexcept {
  return 6 + 2 * servos;
}
constexpr std::size_t ReceiverStatusPayloadBytes(std::size_t servos) noexcept {
  return 32 + 2 * servos;
}

}  // namespace facewire::wire

#endif  // FACEWIRE_CORE_WIRE_SERVO_MESSAGE_H_
