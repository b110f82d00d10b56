#ifndef FACEWIRE_CORE_WIRE_OSC_HOST_COMMAND_H_
#define FACEWIRE_CORE_WIRE_OSC_HOST_COMMAND_H_

#include <array>
#include <cstddef>
#include <span>

#include "core/base/result.h"
#include "core/wire/decoder.h"
#include "core/wire/message.h"
#include "core/wire/osc/reader.h"
#include "core/wire/osc/slip.h"

namespace facewire::wire::osc_host {

// The longest packet in either direction, before SLIP: receivers with 2 KB of memory exist.
inline constexpr std::size_t kMaxPacketBytes = 256;

// Finds the commands in what a host sends. SLIP has no checksum, so a command must be exact: its
// address, no argument or a number that says "pressed", and a packet without a fault from its first
// byte to its last. A stop alone is obeyed for its address, wherever in a packet that is.
class CommandDecoder {
 public:
  CommandDecoder() noexcept = default;
  // Its parts point into its memory.
  CommandDecoder(const CommandDecoder&) = delete;
  CommandDecoder& operator=(const CommandDecoder&) = delete;

  // As Decoder::Next: takes bytes off the front up to the end of the next command. kNotReady: all
  // were taken and none ended. Anything else is no command, and counted: kFull (overflows),
  // kCorrupt (truncated), kUnsupported (an address that is not known: unknown), kInvalidArgument
  // (arguments that the address does not take: malformed). Every command has the id 0.
  Result<Command> Next(std::span<const std::byte>& bytes) noexcept;

  const LinkStats& stats() const noexcept { return stats_; }

 private:
  Result<Command> Count(Result<Command> command) noexcept;

  std::array<std::byte, kMaxPacketBytes> memory_{};
  osc::SlipDecoder slip_{memory_};
  osc::Reader reader_;  // of the last packet, which is still in memory_
  LinkStats stats_;
};

}  // namespace facewire::wire::osc_host

#endif  // FACEWIRE_CORE_WIRE_OSC_HOST_COMMAND_H_
