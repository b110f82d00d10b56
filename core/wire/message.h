#ifndef FACEWIRE_CORE_WIRE_MESSAGE_H_
#define FACEWIRE_CORE_WIRE_MESSAGE_H_

#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <variant>

#include "core/base/capacity.h"
#include "core/base/geometry.h"
#include "core/base/inline_vector.h"
#include "core/base/name.h"
#include "core/base/time.h"
#include "core/rig/rig.h"
#include "core/service_state.h"
#include "core/wire/landmark_part.h"
#include "core/wire/servo_message.h"

// The messages of the native protocol as plain structs. Their bytes: core/wire/README.md.
namespace facewire::wire {

// The numbers are those of the wire: append only. Bit 7 set: from the host to the device.
enum class MessageType : std::uint8_t {
  kRigHeader = 0x01,
  kBone = 0x02,
  kChannel = 0x03,
  kPose = 0x10,
  kStatus = 0x11,
  kAcknowledgement = 0x12,
  kText = 0x13,
  kServoSetup = 0x14,
  kServoPulses = 0x15,
  kLandmarks = 0x16,
  kCommand = 0x80,
  kReceiverStatus = 0x81,
};

// How many parts describe the rig. rig_id (here and below) names one description: poses repeat it,
// so that a host notices that the rig changed.
struct RigHeader {
  std::uint32_t rig_id = 0;
  std::uint8_t bones = 0;     // 0..kMaxBones
  std::uint8_t channels = 0;  // 0..kMaxChannels
  ShortName name{};           // may be empty
};

struct BoneDescription {
  std::uint32_t rig_id = 0;
  std::uint8_t index = 0;
  ShortName name{};
  Point3 rest_cm{};  // in the character's space
};

struct ChannelDescription {
  std::uint32_t rig_id = 0;
  std::uint8_t index = 0;
  ShortName name{};
  ChannelKind kind = ChannelKind::kParameter;  // a kind of a later sender arrives as kParameter
  std::int16_t bone = -1;                      // index of the bone, -1 for none
  float neutral = 0;                           // in the kind's unit; min <= neutral <= max, finite
  float min = 0;
  float max = 1;
};

// Values of one frame, quantised over each channel's range: value = min + q / 65535 * (max - min).
// Made by MakePose, read by ValuesOf (core/wire/pose.h).
struct Pose {
  std::uint32_t rig_id = 0;
  std::uint32_t frame_seq = 0;                   // of RigPose::seq the low 32 bits
  Time captured{};                               // on the device's clock
  std::uint32_t age_us = 0;                      // from the capture to the encoding of this message
  ServiceState state = ServiceState::kStarting;  // a state of a later sender arrives as kFault
  InlineVector<std::uint16_t, kMaxChannels> values{};
};

// How the service fares; sent about once a second. Counters wrap at 2^32.
struct Status {
  std::uint32_t rig_id = 0;
  ServiceState state = ServiceState::kStarting;
  Time now{};  // the device's clock when this was made
  std::uint32_t uptime_s = 0;
  std::uint16_t centi_fps = 0;    // frames a second, in 0.01
  std::uint32_t frames = 0;       // processed
  std::uint32_t dropped = 0;      // captured, but never processed
  std::uint32_t losses = 0;       // times that the face was lost
  std::uint32_t link_errors = 0;  // damaged frames and failed writes, as the device sees its line
  std::uint32_t latency_p50_us =
      0;  // from capture to the last byte handed to the line, recent frames
  std::uint32_t latency_p99_us = 0;
};

// What a host may ask for. The numbers are those of the wire: append only. A Command that arrives
// may hold a number that is not named here; it is answered with CommandResult::kUnknown.
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

using Message =
    std::variant<RigHeader, BoneDescription, ChannelDescription, Pose, Status, Acknowledgement,
                 Command, Text, ServoSetup, ServoPulses, LandmarkPart, ReceiverStatus>;
static_assert(std::is_trivially_copyable_v<Message>);

const char* Name(CommandCode code) noexcept;      // "calibrate_neutral"; "unknown" for a later one
const char* Name(CommandResult result) noexcept;  // "no_face"
const char* Name(ChannelKind kind) noexcept;      // "parameter", "position_x", "pitch"

// Sizes. A frame on the line is: delimiter, COBS of (header, payload, CRC), delimiter.
inline constexpr std::uint8_t kVersion = 1;
inline constexpr std::size_t kHeaderBytes = 4;
inline constexpr std::size_t kCrcBytes = 4;
inline constexpr std::size_t kMaxPayloadBytes = kMaxWirePayload - kHeaderBytes - kCrcBytes;
// The most bytes on the line for a payload of that size: COBS adds one byte per 254 begun.
constexpr std::size_t MaxFrameBytes(std::size_t payload_bytes) noexcept {
  const std::size_t inside = kHeaderBytes + payload_bytes + kCrcBytes;
  return inside + (inside + 253) / 254 + 2;
}
constexpr std::size_t PosePayloadBytes(std::size_t channels) noexcept { return 22 + 2 * channels; }
inline constexpr std::size_t kMaxDescriptionPayloadBytes = 4 + 1 + 1 + 1 + 12 + 1 + kMaxNameLength;
inline constexpr std::size_t kStatusPayloadBytes = 43;
// With the value or measure that some have.
inline constexpr std::size_t kMaxAcknowledgementPayloadBytes = 12 + 4;
inline constexpr std::size_t kMaxCommandPayloadBytes = 3 + 4 + 1;
inline constexpr std::size_t kMaxTextPayloadBytes = 4 + kMaxTextBytes;
// Buffers of these sizes always suffice for the message.
inline constexpr std::size_t kMaxDescriptionFrameBytes = MaxFrameBytes(kMaxDescriptionPayloadBytes);
inline constexpr std::size_t kMaxPoseFrameBytes = MaxFrameBytes(PosePayloadBytes(kMaxChannels));
inline constexpr std::size_t kStatusFrameBytes = MaxFrameBytes(kStatusPayloadBytes);
inline constexpr std::size_t kAcknowledgementFrameBytes =
    MaxFrameBytes(kMaxAcknowledgementPayloadBytes);
inline constexpr std::size_t kCommandFrameBytes = MaxFrameBytes(kMaxCommandPayloadBytes);
inline constexpr std::size_t kTextFrameBytes = MaxFrameBytes(kMaxTextPayloadBytes);
inline constexpr std::size_t kServoSetupFrameBytes =
    MaxFrameBytes(ServoSetupPayloadBytes(kMaxServos));
inline constexpr std::size_t kServoPulsesFrameBytes =
    MaxFrameBytes(ServoPulsesPayloadBytes(kMaxServos));
inline constexpr std::size_t kLandmarkPartFrameBytes =
    MaxFrameBytes(LandmarkPartPayloadBytes(kMaxLandmarksInPart));
inline constexpr std::size_t kReceiverStatusFrameBytes =
    MaxFrameBytes(ReceiverStatusPayloadBytes(kMaxServos));
inline constexpr std::size_t kMaxFrameBytes = MaxFrameBytes(kMaxPayloadBytes);  // of any message
static_assert(PosePayloadBytes(kMaxChannels) <= kMaxPayloadBytes);
static_assert(ServoSetupPayloadBytes(kMaxServos) <= kMaxPayloadBytes);

}  // namespace facewire::wire

#endif  // FACEWIRE_CORE_WIRE_MESSAGE_H_
