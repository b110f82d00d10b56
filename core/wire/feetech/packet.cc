#include "core/wire/feetech/packet.h"

#include <algorithm>
#include <array>

namespace facewire::wire::feetech {
namespace {

constexpr std::size_t kMaxLengthByte = 255;

constexpr bool IsServo(std::uint8_t id) noexcept { return id <= kMaxId; }
constexpr bool IsAddress(std::uint8_t id) noexcept { return IsServo(id) || id == kBroadcast; }

Packet Make(std::uint8_t id, Instruction instruction, std::span<const std::byte> first,
            std::span<const std::byte> second, std::span<std::byte> out) noexcept {
  const std::size_t parameters = first.size() + second.size();
  if (parameters > kMaxParameters) return Errc::kOutOfRange;
  const std::size_t total = 4 + parameters + 2;
  if (out.size() < total) return Errc::kFull;
  out[0] = out[1] = std::byte{0xFF};
  out[2] = static_cast<std::byte>(id);
  out[3] = static_cast<std::byte>(parameters + 2);
  out[4] = static_cast<std::byte>(instruction);
  std::ranges::copy(first, out.subspan(5).begin());
  std::ranges::copy(second, out.subspan(5 + first.size()).begin());
  out[total - 1] = static_cast<std::byte>(Checksum(out.subspan(2, total - 3)));
  return out.first(total);
}

}  // namespace

std::uint8_t Checksum(std::span<const std::byte> from_id) noexcept {
  unsigned sum = 0;
  for (std::byte b : from_id) sum += std::to_integer<unsigned>(b);
  return static_cast<std::uint8_t>(~sum);
}

std::uint16_t Get16(std::span<const std::byte> from, ByteOrder order) noexcept {
  const std::size_t low = order == ByteOrder::kLowFirst ? 0 : 1;
  return static_cast<std::uint16_t>(std::to_integer<unsigned>(from[low]) |
                                    std::to_integer<unsigned>(from[1 - low]) << 8U);
}

void Put16(std::uint16_t value, ByteOrder order, std::span<std::byte> to) noexcept {
  const std::size_t low = order == ByteOrder::kLowFirst ? 0 : 1;
  to[low] = static_cast<std::byte>(value & 0xFFU);
  to[1 - low] = static_cast<std::byte>(value >> 8U);
}

Packet Ping(std::uint8_t id, std::span<std::byte> out) noexcept {
  if (!IsServo(id)) return Errc::kOutOfRange;
  return Make(id, Instruction::kPing, {}, {}, out);
}

Packet Read(std::uint8_t id, std::uint8_t address, std::uint8_t length,
            std::span<std::byte> out) noexcept {
  if (!IsServo(id) || length == 0) return Errc::kOutOfRange;
  const std::array what = {static_cast<std::byte>(address), static_cast<std::byte>(length)};
  return Make(id, Instruction::kRead, what, {}, out);
}

Packet Write(std::uint8_t id, std::uint8_t address, std::span<const std::byte> data,
             std::span<std::byte> out) noexcept {
  if (!IsAddress(id) || data.empty()) return Errc::kOutOfRange;
  const std::array where = {static_cast<std::byte>(address)};
  return Make(id, Instruction::kWrite, where, data, out);
}

Packet Reboot(std::uint8_t id, std::span<std::byte> out) noexcept {
  if (!IsServo(id)) return Errc::kOutOfRange;
  return Make(id, Instruction::kReboot, {}, {}, out);
}

Packet SyncRead(std::uint8_t address, std::uint8_t length, std::span<const std::uint8_t> ids,
                std::span<std::byte> out) noexcept {
  if (ids.empty() || length == 0 || !std::ranges::all_of(ids, IsServo)) return Errc::kOutOfRange;
  const std::array what = {static_cast<std::byte>(address), static_cast<std::byte>(length)};
  return Make(kBroadcast, Instruction::kSyncRead, what, std::as_bytes(ids), out);
}

SyncWrite::SyncWrite(std::uint8_t address, std::uint8_t length, std::span<std::byte> out) noexcept
    : out_(out), address_(address), length_(length) {}

bool SyncWrite::Add(std::uint8_t id, std::span<const std::byte> data) noexcept {
  if (!IsServo(id) || data.empty() || data.size() != length_) return false;
  const std::size_t after = size_ + 1 + data.size();
  // The length byte counts from the instruction to the checksum.
  if (after + 1 > out_.size() || after + 1 - 4 > kMaxLengthByte) return false;
  out_[size_] = static_cast<std::byte>(id);
  std::ranges::copy(data, out_.subspan(size_ + 1).begin());
  size_ = after;
  return true;
}

Packet SyncWrite::Finish() noexcept {
  if (out_.size() < kHead + 1) return Errc::kFull;
  if (empty()) return Errc::kOutOfRange;
  out_[0] = out_[1] = std::byte{0xFF};
  out_[2] = static_cast<std::byte>(kBroadcast);
  out_[3] = static_cast<std::byte>(size_ + 1 - 4);
  out_[4] = static_cast<std::byte>(Instruction::kSyncWrite);
  out_[5] = static_cast<std::byte>(address_);
  out_[6] = static_cast<std::byte>(length_);
  out_[size_] = static_cast<std::byte>(Checksum(out_.subspan(2, size_ - 2)));
  return out_.first(size_ + 1);
}

}  // namespace facewire::wire::feetech
