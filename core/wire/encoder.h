#ifndef FACEWIRE_CORE_WIRE_ENCODER_H_
#define FACEWIRE_CORE_WIRE_ENCODER_H_

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/base/result.h"
#include "core/wire/message.h"

namespace facewire::wire {

// Turns messages into frames for one direction of one line, and numbers them. Allocates nothing.
class Encoder {
 public:
  // Writes the frame, with both of its delimiters, to the front of `out` and returns that part.
  // kFull: `out` is too small (k...FrameBytes in message.h always suffices). kInvalidArgument: a
  // number that is not finite, min <= neutral <= max does not hold, a bone index above 254, or a
  // rule of core/wire/servo_message.h or landmark_part.h.
  // After an error nothing may be sent, and the next frame gets the number that this one would have
  // had.
  Result<std::span<const std::byte>> Encode(const RigHeader&, std::span<std::byte> out) noexcept;
  Result<std::span<const std::byte>> Encode(const BoneDescription&,
                                            std::span<std::byte> out) noexcept;
  Result<std::span<const std::byte>> Encode(const ChannelDescription&,
                                            std::span<std::byte> out) noexcept;
  Result<std::span<const std::byte>> Encode(const Pose&, std::span<std::byte> out) noexcept;
  Result<std::span<const std::byte>> Encode(const Status&, std::span<std::byte> out) noexcept;
  Result<std::span<const std::byte>> Encode(const Acknowledgement&,
                                            std::span<std::byte> out) noexcept;
  Result<std::span<const std::byte>> Encode(const Command&, std::span<std::byte> out) noexcept;
  Result<std::span<const std::byte>> Encode(const Text&, std::span<std::byte> out) noexcept;
  Result<std::span<const std::byte>> Encode(const ServoSetup&, std::span<std::byte> out) noexcept;
  Result<std::span<const std::byte>> Encode(const ServoPulses&, std::span<std::byte> out) noexcept;
  Result<std::span<const std::byte>> Encode(const LandmarkPart&, std::span<std::byte> out) noexcept;
  Result<std::span<const std::byte>> Encode(const ReceiverStatus&,
                                            std::span<std::byte> out) noexcept;
  // Whichever the message is.
  Result<std::span<const std::byte>> Encode(const Message&, std::span<std::byte> out) noexcept;

  // The next frame's number. 0 belongs to the first frame after a start alone: 65535 is followed by
  // 1, so a receiver recognises a restart.
  std::uint16_t sequence() const noexcept { return sequence_; }

 private:
  class Writer;
  Result<std::span<const std::byte>> Finish(Writer& writer) noexcept;

  std::uint16_t sequence_ = 0;
};

}  // namespace facewire::wire

#endif  // FACEWIRE_CORE_WIRE_ENCODER_H_
