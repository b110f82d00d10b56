#ifndef FACEWIRE_CORE_WIRE_OSC_HOST_ENCODER_H_
#define FACEWIRE_CORE_WIRE_OSC_HOST_ENCODER_H_

#include <cstddef>
#include <span>

#include "core/base/result.h"
#include "core/wire/message.h"

// What the board says in OSC, apart from poses (pose_writer.h). README.md here is the
// specification.
namespace facewire::wire::osc_host {

// The message as one packet in SLIP, at the front of `out`. kFull (MaxSlipBytes(kMaxPacketBytes)
// always suffices); kUnsupported: OSC has no such message here.
Result<std::span<const std::byte>> Encode(const RigHeader&, std::span<std::byte> out) noexcept;
Result<std::span<const std::byte>> Encode(const BoneDescription&,
                                          std::span<std::byte> out) noexcept;
Result<std::span<const std::byte>> Encode(const ChannelDescription&,
                                          std::span<std::byte> out) noexcept;
Result<std::span<const std::byte>> Encode(const Status&, std::span<std::byte> out) noexcept;
Result<std::span<const std::byte>> Encode(const Acknowledgement&,
                                          std::span<std::byte> out) noexcept;
// Whichever of them the message is.
Result<std::span<const std::byte>> Encode(const Message&, std::span<std::byte> out) noexcept;

}  // namespace facewire::wire::osc_host

#endif  // FACEWIRE_CORE_WIRE_OSC_HOST_ENCODER_H_
