#ifndef FACEWIRE_CORE_WIRE_OSC_SLIP_H_
#define FACEWIRE_CORE_WIRE_OSC_SLIP_H_

#include <cstddef>
#include <span>

#include "core/base/result.h"

namespace facewire::wire::osc {

// The most bytes that a packet takes on a line: both ends, and every byte escaped.
constexpr std::size_t MaxSlipBytes(std::size_t packet_bytes) noexcept {
  return 2 * packet_bytes + 2;
}

// A packet for a serial line: SLIP (RFC 1055) with END at both ends, as OSC 1.1 has it, so that
// noise between two packets costs neither. SLIP has no checksum. Writes to the front of `out` and
// returns what it wrote. kInvalidArgument: an empty packet, which a receiver ignores; kFull
// (MaxSlipBytes always suffices).
Result<std::span<const std::byte>> Slip(std::span<const std::byte> packet,
                                        std::span<std::byte> out) noexcept;

// Finds the packets in a stream, however it is cut into pieces, in the caller's memory. What a
// packet means is not its business: without a checksum it cannot know whether it is whole.
class SlipDecoder {
 public:
  // `memory` is borrowed; packets that are longer are dropped.
  explicit SlipDecoder(std::span<std::byte> memory) noexcept : memory_(memory) {}

  // Takes bytes off the front of `bytes` up to the end of the next packet, which is valid until the
  // next call. Empty packets are passed over. kNotReady: all were taken and no packet ended. The
  // packet that ended is dropped: kFull, it is longer than the memory; kCorrupt, an escape that
  // stands for nothing.
  Result<std::span<const std::byte>> Next(std::span<const std::byte>& bytes) noexcept;

 private:
  void Append(std::byte byte) noexcept;

  std::span<std::byte> memory_;
  std::size_t size_ = 0;
  bool escaped_ = false;  // the byte before was an escape
  Errc error_{};          // of the packet that is being read; none when 0
};

}  // namespace facewire::wire::osc

#endif  // FACEWIRE_CORE_WIRE_OSC_SLIP_H_
