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
#include "core/wire/command.h"
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

using Message =
    std::variant<RigHeader, BoneDescription, ChannelDescription, Pose, Status, Acknowledgement,
                 Command, Text, ServoSetup, ServoPulses, LandmarkPart, ReceiverStatus>;
static_assert(std::is_trivially_copyable_v<Message>);

const char* Name(ChannelKind kind) noexcept;  // "parameter", "position_x", "pitch"

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
