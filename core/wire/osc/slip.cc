#include "core/wire/osc/slip.h"

namespace facewire::wire::osc {
namespace {

constexpr std::byte kEnd{0xC0};
constexpr std::byte kEscape{0xDB};
constexpr std::byte kEscapedEnd{0xDC};
constexpr std::byte kEscapedEscape{0xDD};

constexpr bool IsEscaped(std::byte b) noexcept { return b == kEnd || b == kEscape; }

}  // namespace

Result<std::span<const std::byte>> Slip(std::span<const std::byte> packet,
                                        std::span<std::byte> out) noexcept {
  if (packet.empty()) return Errc::kInvalidArgument;
  std::size_t needed = 2;
  for (std::byte b : packet) needed += IsEscaped(b) ? 2 : 1;
  if (out.size() < needed) return Errc::kFull;
  std::size_t size = 0;
  out[size++] = kEnd;
  for (std::byte b : packet) {
    if (IsEscaped(b)) {
      out[size++] = kEscape;
      out[size++] = b == kEnd ? kEscapedEnd : kEscapedEscape;
    } else {
      out[size++] = b;
    }
  }
  out[size++] = kEnd;
  return out.first(size);
}

}  // namespace facewire::wire::osc
