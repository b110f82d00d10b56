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

}  // namespace facewire::wire::osc

#endif  // FACEWIRE_CORE_WIRE_OSC_SLIP_H_
