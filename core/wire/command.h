#ifndef FACEWIRE_CORE_WIRE_COMMAND_H_
#define FACEWIRE_CORE_WIRE_COMMAND_H_

#include <cstddef>
#include <cstdint>

#include "core/base/inline_vector.h"
#include "core/base/time.h"

// What a host may ask for, and the answers. Their bytes: core/wire/README.md.
namespace facewire::wire {

// The numbers are those of the wire: append only. A Command that arrives may hold a number that is
// not named here; it is answered with CommandResult::kUnknown.
enum class CommandCode : std::uint8_t {
  kPing = 1,              // only the acknowledgement
  kDescribeRig = 2,       // send the whole rig description again
  kCalibrateNeutral = 3,  // take the performer's present face as neutral
  kRest = 4,              // ease to neutral and stay there until kRelease
  kStop = 5,              // emergency stop, latched until kRelease
  kRelease = 6,           // end a stop or a rest that a command began
  kBlendProfile = 7,      // value: the part of the personal profile, 0..1
  kReport = 8,            // how the service fares, as Text; on the control socket alone, as is
  kReload = 9,            // read the configuration again; Text says what is wrong with it
  // item: a servo, by its place in the rig's file; value: its position, in its own unit. A hand
  // goes before the performer for as long as it repeats this within the rig's `fresh` (200 ms).
  kMoveServo = 10,
  kLandmarks = 11,  // value: pictures a second, 0..60, for the next 5 s
};

struct Command {
  std::uint16_t id = 0;  // the host's own number, repeated in the acknowledgement
  CommandCode code = CommandCode::kPing;
  float value = 0;        // on the wire only where TakesValue(code)
  std::uint8_t item = 0;  // on the wire only where TakesItem(code)
};
constexpr bool TakesItem(CommandCode code) noexcept { return code == CommandCode::kMoveServo; }
constexpr bool TakesValue(CommandCode code) noexcept {
  return code == CommandCode::kBlendProfile || code == CommandCode::kLandmarks || TakesItem(code);
}

// The numbers are those of the wire: append only; one that is not named here is a failure.
enum class CommandResult : std::uint8_t {
  kOk = 0,
  kUnknown = 1,  // this device does not know the command
  kRefused = 2,  // not in this state: a release while the stop input is still asserted
  kNoFace = 3,   // calibration needs a face
  kFailed = 4,   // tried, and something went wrong
  // Why a calibration was refused; `measure` of the acknowledgement says how much. All of them look
  // at one second.
  kHeadTurned = 5,  // degrees
  kHeadMoved = 6,   // cm
  kFaceMoved = 7,   // cm
  kEyesClosed = 8,  // a blink, or throughout; how far they closed, 0..1
  kMouthOpen = 9,   // the lips' gap as a part of the mouth's width
  // Done, but only until the device starts again: it cannot write where it keeps things. Not a
  // failure either.
  kNotKept = 10,
};
// Whether what was asked for is done.
constexpr bool Succeeded(CommandResult result) noexcept {
  return result == CommandResult::kOk || result == CommandResult::kNotKept;
}
constexpr bool HasMeasure(CommandResult result) noexcept {
  return result >= CommandResult::kHeadTurned && result <= CommandResult::kMouthOpen;
}

struct Acknowledgement {
  std::uint16_t id = 0;                   // of the command
  CommandCode code = CommandCode::kPing;  // of the command
  CommandResult result = CommandResult::kOk;
  Time now{};         // the device's clock: with a ping, a host learns the offset to its own
  float measure = 0;  // on the wire only where HasMeasure(result)
};

// Part of what an answer says in words; the acknowledgement with the same id comes after the last
// part. The whole is UTF-8, lines that end with '\n'.
inline constexpr std::size_t kMaxTextBytes = 480;
struct Text {
  std::uint16_t id = 0;  // of the command
  InlineVector<char, kMaxTextBytes> text{};
};

const char* Name(CommandCode code) noexcept;      // "calibrate_neutral"; "unknown" for a later one
const char* Name(CommandResult result) noexcept;  // "no_face"

}  // namespace facewire::wire

#endif  // FACEWIRE_CORE_WIRE_COMMAND_H_
