#include "core/wire/osc/slip.h"

#include <utility>

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

Result<std::span<const std::byte>> SlipDecoder::Next(std::span<const std::byte>& bytes) noexcept {
  while (!bytes.empty()) {
    const std::byte byte = bytes.front();
    bytes = bytes.subspan(1);
    if (byte != kEnd) {
      Append(byte);
      continue;
    }
    if (escaped_) error_ = Errc::kCorrupt;
    const Errc error = std::exchange(error_, Errc{});
    const std::size_t size = std::exchange(size_, 0);
    escaped_ = false;
    if (error != Errc{}) return error;
    if (size > 0) return std::span<const std::byte>(memory_.first(size));
  }
  return Errc::kNotReady;
}

void SlipDecoder::Append(std::byte byte) noexcept {
  if (error_ != Errc{}) return;
  if (!escaped_ && byte == kEscape) {
    escaped_ = true;
    return;
  }
  if (std::exchange(escaped_, false)) {
    if (byte != kEscapedEnd && byte != kEscapedEscape) {
      error_ = Errc::kCorrupt;
      return;
    }
    byte = byte == kEscapedEnd ? kEnd : kEscape;
  }
  if (size_ == memory_.size()) {
    error_ = Errc::kFull;
    return;
  }
  memory_[size_++] = byte;
}

}  // namespace facewire::wire::osc
