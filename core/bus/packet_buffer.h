#ifndef FACEWIRE_CORE_BUS_PACKET_BUFFER_H_
#define FACEWIRE_CORE_BUS_PACKET_BUFFER_H_

#include <array>
#include <cstddef>
#include <span>

#include "core/base/result.h"
#include "core/bus/servo_bus.h"

namespace facewire::bus {

// The packets of one tick, one after the other.
class PacketBuffer {
 public:
  void Clear() noexcept { used_ = 0; }
  // Where the next packet goes; Took says how long it became.
  std::span<std::byte> rest() noexcept { return std::span(bytes_).subspan(used_); }
  void Took(std::size_t bytes) noexcept { used_ += bytes; }
  // False when there is none.
  bool Took(const Result<std::span<const std::byte>>& packet) noexcept {
    if (packet) used_ += packet->size();
    return packet.has_value();
  }
  std::size_t size() const noexcept { return used_; }
  std::span<const std::byte> bytes() const noexcept { return std::span(bytes_).first(used_); }

 private:
  std::array<std::byte, kMaxTickBytes> bytes_{};
  std::size_t used_ = 0;
};

}  // namespace facewire::bus

#endif  // FACEWIRE_CORE_BUS_PACKET_BUFFER_H_
