#include "core/wire/maestro/maestro.h"

#include <algorithm>

namespace facewire::wire::maestro {
namespace {

constexpr std::uint8_t kPololuStart = 0xAA;
constexpr std::uint8_t kMiniSscStart = 0xFF;

constexpr std::byte Low7(std::uint16_t value) noexcept {
  return static_cast<std::byte>(value & 0x7FU);
}
constexpr std::byte High7(std::uint16_t value) noexcept {
  return static_cast<std::byte>((value >> 7U) & 0x7FU);
}

constexpr std::size_t BytesOf(Reply reply) noexcept {
  switch (reply) {
    case Reply::kNone:
      return 0;
    case Reply::kMovingState:
      return 1;
    case Reply::kPosition:
    case Reply::kErrors:
      return 2;
  }
  return 0;
}

constexpr std::uint16_t LargestOf(Reply reply) noexcept {
  switch (reply) {
    case Reply::kNone:
      return 0;
    case Reply::kMovingState:
      return 1;
    case Reply::kPosition:
      return kMaxValue;
    case Reply::kErrors:
      return kErrorMask;
  }
  return 0;
}

}  // namespace

const char* Name(Error error) noexcept {
  switch (error) {
    case Error::kSignal:
      return "serial signal";
    case Error::kOverrun:
      return "serial overrun";
    case Error::kBufferFull:
      return "serial buffer full";
    case Error::kCrc:
      return "serial CRC";
    case Error::kProtocol:
      return "serial protocol";
    case Error::kTimeout:
      return "serial timeout";
    case Error::kScriptStack:
      return "script stack";
    case Error::kScriptCalls:
      return "script call stack";
    case Error::kProgramCounter:
      return "script program counter";
  }
  return "unknown";
}

std::uint8_t Crc7(std::span<const std::byte> bytes) noexcept {
  unsigned crc = 0;
  for (std::byte b : bytes) {
    crc ^= std::to_integer<unsigned>(b);
    for (int bit = 0; bit < 8; ++bit) {
      if ((crc & 1U) != 0) crc ^= 0x91U;
      crc >>= 1U;
    }
  }
  return static_cast<std::uint8_t>(crc);
}

Encoder::Packet Encoder::Make(std::uint8_t command, std::span<const std::byte> data,
                              std::span<std::byte> out) const noexcept {
  if (line_.device > 127) return Errc::kOutOfRange;
  const std::size_t head = line_.pololu ? 3 : 1;
  std::size_t size = head + data.size();
  if (out.size() < size + (line_.crc ? 1U : 0U)) return Errc::kFull;
  if (line_.pololu) {
    out[0] = std::byte{kPololuStart};
    out[1] = static_cast<std::byte>(line_.device);
    out[2] = static_cast<std::byte>(command & 0x7FU);
  } else {
    out[0] = static_cast<std::byte>(command);
  }
  std::ranges::copy(data, out.subspan(head).begin());
  if (line_.crc) {
    out[size] = static_cast<std::byte>(Crc7(out.first(size)));
    ++size;
  }
  return out.first(size);
}

Encoder::Packet Encoder::SetValue(std::uint8_t command, std::uint8_t channel, std::uint16_t value,
                                  std::span<std::byte> out) const noexcept {
  if (channel >= kMaxChannels || value > kMaxValue) return Errc::kOutOfRange;
  const std::array data = {static_cast<std::byte>(channel), Low7(value), High7(value)};
  return Make(command, data, out);
}

Encoder::Packet Encoder::SetTarget(std::uint8_t channel, std::uint16_t target,
                                   std::span<std::byte> out) const noexcept {
  return SetValue(0x84, channel, target, out);
}

Encoder::Packet Encoder::SetTargets(std::uint8_t first, std::span<const std::uint16_t> targets,
                                    std::span<std::byte> out) const noexcept {
  if (targets.empty() || first + targets.size() > kMaxChannels) return Errc::kOutOfRange;
  std::array<std::byte, 2 + 2 * kMaxChannels> data{};
  std::size_t size = 0;
  data[size++] = static_cast<std::byte>(targets.size());
  data[size++] = static_cast<std::byte>(first);
  for (std::uint16_t target : targets) {
    if (target > kMaxValue) return Errc::kOutOfRange;
    data[size++] = Low7(target);
    data[size++] = High7(target);
  }
  return Make(0x9F, std::span(data).first(size), out);
}

Encoder::Packet Encoder::SetSpeed(std::uint8_t channel, std::uint16_t speed,
                                  std::span<std::byte> out) const noexcept {
  return SetValue(0x87, channel, speed, out);
}

Encoder::Packet Encoder::SetAcceleration(std::uint8_t channel, std::uint16_t acceleration,
                                         std::span<std::byte> out) const noexcept {
  if (acceleration > 255) return Errc::kOutOfRange;
  return SetValue(0x89, channel, acceleration, out);
}

Encoder::Packet Encoder::GetPosition(std::uint8_t channel,
                                     std::span<std::byte> out) const noexcept {
  if (channel >= kMaxChannels) return Errc::kOutOfRange;
  const std::array data = {static_cast<std::byte>(channel)};
  return Make(0x90, data, out);
}

Encoder::Packet Encoder::GetMovingState(std::span<std::byte> out) const noexcept {
  return Make(0x93, {}, out);
}

Encoder::Packet Encoder::GetErrors(std::span<std::byte> out) const noexcept {
  return Make(0xA1, {}, out);
}

Encoder::Packet Encoder::GoHome(std::span<std::byte> out) const noexcept {
  return Make(0xA2, {}, out);
}

Encoder::Packet MiniSsc(std::uint8_t channel, std::uint8_t value,
                        std::span<std::byte> out) noexcept {
  if (channel > 254 || value > 254) return Errc::kOutOfRange;
  if (out.size() < 3) return Errc::kFull;
  out[0] = std::byte{kMiniSscStart};
  out[1] = static_cast<std::byte>(channel);
  out[2] = static_cast<std::byte>(value);
  return out.first(3);
}

void ReplyReader::Expect(Reply reply) noexcept {
  expected_ = reply;
  size_ = 0;
}

Result<std::uint16_t> ReplyReader::Next(std::span<const std::byte>& bytes) noexcept {
  const std::size_t wanted = BytesOf(expected_);
  if (wanted == 0) {
    stray_ += bytes.size();
    bytes = {};
    return Errc::kNotReady;
  }
  while (size_ < wanted && !bytes.empty()) {
    bytes_[size_++] = std::to_integer<std::uint8_t>(bytes.front());
    bytes = bytes.subspan(1);
  }
  if (size_ < wanted) return Errc::kNotReady;
  const unsigned high = wanted > 1 ? bytes_[1] : 0U;
  const auto value = static_cast<std::uint16_t>(bytes_[0] | high << 8U);
  const std::uint16_t largest = LargestOf(expected_);
  Forget();
  if (value > largest) return Errc::kCorrupt;
  return value;
}

}  // namespace facewire::wire::maestro
