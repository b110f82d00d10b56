#include "core/wire/dynamixel/status.h"

#include "core/wire/dynamixel/packet.h"

namespace facewire::wire::dynamixel {
namespace {

constexpr std::uint32_t kHeader = 0xFFFFFD00;
constexpr std::size_t kHeaderBytes = 7;
constexpr std::size_t kInstructionAt = 7;
constexpr std::size_t kErrorAt = 8;
constexpr std::size_t kParametersAt = 9;
constexpr std::size_t kCrcBytes = 2;
constexpr std::size_t kMinLength = 3;  // instruction, CRC

}  // namespace

const char* Name(StatusError error) noexcept {
  switch (error) {
    case StatusError::kNone:
      return "none";
    case StatusError::kFailed:
      return "failed";
    case StatusError::kInstruction:
      return "unknown instruction";
    case StatusError::kCrc:
      return "CRC";
    case StatusError::kRange:
      return "value out of range";
    case StatusError::kLength:
      return "too few bytes";
    case StatusError::kLimit:
      return "value beyond a limit";
    case StatusError::kAccess:
      return "no access";
  }
  return "unknown";
}

void StatusReader::Reset() noexcept {
  if (size_ != 0) ++stats_.damaged;
  size_ = 0;
  total_ = 0;
  window_ = 0;
}

bool StatusReader::Take(std::uint8_t byte) noexcept {
  window_ = window_ << 8U | byte;
  if (size_ != 0) {
    packet_[size_++] = static_cast<std::byte>(byte);
    if (size_ == kHeaderBytes) {
      const std::size_t length =
          std::to_integer<std::size_t>(packet_[5]) | std::to_integer<std::size_t>(packet_[6]) << 8U;
      total_ = kHeaderBytes + length;
      if (length < kMinLength || total_ > packet_.size()) {
        ++stats_.damaged;
        size_ = 0;
      }
    } else if (size_ > kHeaderBytes && size_ == total_) {
      const std::uint16_t crc = Crc16(std::span(packet_).first(total_ - kCrcBytes));
      size_ = 0;
      if (packet_[total_ - 2] == static_cast<std::byte>(crc & 0xFFU) &&
          packet_[total_ - 1] == static_cast<std::byte>(crc >> 8U)) {
        window_ = 0;
        return true;
      }
      ++stats_.damaged;
    }
  }
  if (window_ == kHeader) {
    if (size_ != 0) ++stats_.damaged;
    packet_[0] = packet_[1] = std::byte{0xFF};
    packet_[2] = std::byte{0xFD};
    packet_[3] = std::byte{0x00};
    size_ = 4;
    total_ = 0;
  }
  return false;
}

bool StatusReader::Unstuff() noexcept {
  const std::size_t end = total_ - kCrcBytes;
  std::size_t to = kParametersAt;
  unsigned run = 0;
  for (std::size_t at = kParametersAt; at < end; ++at) {
    const std::byte b = packet_[at];
    packet_[to++] = b;
    if (b == std::byte{0xFF}) {
      run = run < 2 ? run + 1 : 2;
    } else if (b == std::byte{0xFD} && run == 2) {
      if (at + 1 == end || packet_[at + 1] != std::byte{0xFD}) return false;
      ++at;
      run = 0;
    } else {
      run = 0;
    }
  }
  parameters_ = to - kParametersAt;
  return true;
}

Result<Status> StatusReader::Next(std::span<const std::byte>& bytes) noexcept {
  while (!bytes.empty()) {
    const auto byte = std::to_integer<std::uint8_t>(bytes.front());
    bytes = bytes.subspan(1);
    if (!Take(byte)) continue;
    if (packet_[kInstructionAt] != static_cast<std::byte>(Instruction::kStatus)) {
      ++stats_.instructions;
      continue;
    }
    if (total_ < kParametersAt + kCrcBytes || !Unstuff()) {
      ++stats_.damaged;
      continue;
    }
    ++stats_.packets;
    const auto error = std::to_integer<std::uint8_t>(packet_[kErrorAt]);
    const unsigned number = error & 0x7FU;
    return Status{.id = std::to_integer<std::uint8_t>(packet_[4]),
                  .error = number <= static_cast<unsigned>(StatusError::kAccess)
                               ? static_cast<StatusError>(number)
                               : StatusError::kFailed,
                  .alert = (error & 0x80U) != 0,
                  .parameters = std::span(packet_).subspan(kParametersAt, parameters_)};
  }
  return Errc::kNotReady;
}

}  // namespace facewire::wire::dynamixel
