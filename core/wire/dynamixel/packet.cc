#include "core/wire/dynamixel/packet.h"

namespace facewire::wire::dynamixel {
namespace {

constexpr std::size_t kHeaderBytes = 7;  // FF FF FD 00 id lenL lenH
constexpr std::size_t kCrcBytes = 2;

constexpr bool IsServo(std::uint8_t id) noexcept { return id <= kMaxId; }
constexpr bool IsAddress(std::uint8_t id) noexcept { return IsServo(id) || id == kBroadcast; }

// What fits before stuffing, where the worst turns three bytes into four.
constexpr std::size_t UnstuffedRoom(std::size_t out) noexcept {
  constexpr std::size_t kFixed = kHeaderBytes + 1 + 4 + kCrcBytes;  // instruction, address, length
  return out < kFixed + 2 ? 0 : (out - kFixed - 2) / 4 * 3;
}

}  // namespace

std::uint16_t Crc16(std::span<const std::byte> bytes) noexcept {
  unsigned crc = 0;
  for (std::byte b : bytes) {
    crc ^= std::to_integer<unsigned>(b) << 8U;
    for (int bit = 0; bit < 8; ++bit) {
      crc = (crc << 1U) ^ ((crc & 0x8000U) != 0 ? 0x8005U : 0U);
    }
    crc &= 0xFFFFU;
  }
  return static_cast<std::uint16_t>(crc);
}

PacketWriter::PacketWriter(std::uint8_t id, Instruction instruction,
                           std::span<std::byte> out) noexcept
    : out_(out) {
  for (std::uint8_t b : {std::uint8_t{0xFF}, std::uint8_t{0xFF}, std::uint8_t{0xFD},
                         std::uint8_t{0x00}, id, std::uint8_t{0}, std::uint8_t{0}}) {
    Put(b);
  }
  Add(static_cast<std::uint8_t>(instruction));
}

void PacketWriter::Put(std::uint8_t value) noexcept {
  if (size_ < out_.size()) out_[size_] = static_cast<std::byte>(value);
  ++size_;  // past the end: Finish says that it did not fit
}

void PacketWriter::Add(std::uint8_t value) noexcept {
  Put(value);
  if (value == 0xFF) {
    run_ = run_ < 2 ? run_ + 1 : 2;
  } else if (value == 0xFD && run_ == 2) {
    Put(0xFD);  // so that no header can appear inside a packet
    run_ = 0;
  } else {
    run_ = 0;
  }
}

void PacketWriter::Add16(std::uint16_t value) noexcept {
  Add(static_cast<std::uint8_t>(value & 0xFFU));
  Add(static_cast<std::uint8_t>(value >> 8U));
}

void PacketWriter::Add(std::span<const std::byte> bytes) noexcept {
  for (std::byte b : bytes) Add(std::to_integer<std::uint8_t>(b));
}

Packet PacketWriter::Finish() noexcept {
  const std::size_t total = size_ + kCrcBytes;
  if (total > out_.size()) return Errc::kFull;
  const std::size_t length = total - kHeaderBytes;  // stuffing included
  out_[5] = static_cast<std::byte>(length & 0xFFU);
  out_[6] = static_cast<std::byte>(length >> 8U);
  const std::uint16_t crc = Crc16(out_.first(size_));
  Put(static_cast<std::uint8_t>(crc & 0xFFU));
  Put(static_cast<std::uint8_t>(crc >> 8U));
  return out_.first(total);
}

Packet Ping(std::uint8_t id, std::span<std::byte> out) noexcept {
  if (!IsAddress(id)) return Errc::kOutOfRange;
  return PacketWriter(id, Instruction::kPing, out).Finish();
}

Packet Read(std::uint8_t id, std::uint16_t address, std::uint16_t length,
            std::span<std::byte> out) noexcept {
  if (!IsServo(id) || length == 0) return Errc::kOutOfRange;
  PacketWriter writer(id, Instruction::kRead, out);
  writer.Add16(address);
  writer.Add16(length);
  return writer.Finish();
}

Packet Write(std::uint8_t id, std::uint16_t address, std::span<const std::byte> data,
             std::span<std::byte> out) noexcept {
  if (!IsAddress(id) || data.empty()) return Errc::kOutOfRange;
  PacketWriter writer(id, Instruction::kWrite, out);
  writer.Add16(address);
  writer.Add(data);
  return writer.Finish();
}

Packet Reboot(std::uint8_t id, std::span<std::byte> out) noexcept {
  if (!IsAddress(id)) return Errc::kOutOfRange;
  return PacketWriter(id, Instruction::kReboot, out).Finish();
}

Packet SyncRead(std::uint16_t address, std::uint16_t length, std::span<const std::uint8_t> ids,
                std::span<std::byte> out) noexcept {
  if (ids.empty() || length == 0) return Errc::kOutOfRange;
  PacketWriter writer(kBroadcast, Instruction::kSyncRead, out);
  writer.Add16(address);
  writer.Add16(length);
  for (std::uint8_t id : ids) {
    if (!IsServo(id)) return Errc::kOutOfRange;
    writer.Add(id);
  }
  return writer.Finish();
}

SyncWrite::SyncWrite(std::uint16_t address, std::uint16_t length, std::span<std::byte> out) noexcept
    : writer_(kBroadcast, Instruction::kSyncWrite, out),
      left_(UnstuffedRoom(out.size())),
      length_(length) {
  writer_.Add16(address);
  writer_.Add16(length);
}

bool SyncWrite::Add(std::uint8_t id, std::span<const std::byte> data) noexcept {
  if (!IsServo(id) || data.empty() || data.size() != length_ || left_ < 1 + data.size()) {
    return false;
  }
  writer_.Add(id);
  writer_.Add(data);
  left_ -= 1 + data.size();
  empty_ = false;
  return true;
}

Packet SyncWrite::Finish() noexcept {
  if (empty_) return Errc::kOutOfRange;
  return writer_.Finish();
}

}  // namespace facewire::wire::dynamixel
