#ifndef FACEWIRE_CORE_WIRE_FEETECH_PACKET_H_
#define FACEWIRE_CORE_WIRE_FEETECH_PACKET_H_

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/base/result.h"

// Instruction packets of Feetech's serial bus servos (STS, SMS and SCS series). README.md here is
// the specification.
namespace facewire::wire::feetech {

inline constexpr std::uint8_t kMaxId = 253;
inline constexpr std::uint8_t kBroadcast = 0xFE;
inline constexpr std::size_t kMaxParameters = 253;  // the length byte counts two more
inline constexpr std::size_t kMaxPacketBytes = 4 + 255;

enum class Instruction : std::uint8_t {
  kPing = 0x01,
  kRead = 0x02,
  kWrite = 0x03,
  kReboot = 0x08,
  kSyncRead = 0x82,
  kSyncWrite = 0x83,
};

// Values of two bytes: STS and SMS (magnetic encoder) keep the low byte first, SCS (potentiometer)
// the high byte.
enum class ByteOrder : std::uint8_t { kLowFirst, kHighFirst };

// The last byte of a packet: all bits of the sum from the id on, inverted.
std::uint8_t Checksum(std::span<const std::byte> from_id) noexcept;

// Signed values are a sign and a magnitude: `sign_bit` set means negative.
constexpr int FromSignMagnitude(std::uint16_t raw, unsigned sign_bit) noexcept {
  const unsigned sign = 1U << sign_bit;
  const int magnitude = static_cast<int>(raw & (sign - 1));
  return (raw & sign) != 0 ? -magnitude : magnitude;
}
// A magnitude that has no room below the sign bit becomes the largest that has.
constexpr std::uint16_t ToSignMagnitude(int value, unsigned sign_bit) noexcept {
  const unsigned sign = 1U << sign_bit;
  const unsigned wide =
      value < 0 ? 0U - static_cast<unsigned>(value) : static_cast<unsigned>(value);
  const unsigned magnitude = wide < sign ? wide : sign - 1;
  return static_cast<std::uint16_t>(value < 0 ? sign | magnitude : magnitude);
}

// Both need two bytes.
std::uint16_t Get16(std::span<const std::byte> from, ByteOrder order) noexcept;
void Put16(std::uint16_t value, ByteOrder order, std::span<std::byte> to) noexcept;

// Every function writes one packet to the beginning of `out` and returns it. kOutOfRange: an id
// that is neither 0 to kMaxId nor kBroadcast (where that makes sense), or more or fewer bytes than
// a packet holds; kFull: out is too small.
using Packet = Result<std::span<const std::byte>>;

// Answered with an empty status.
Packet Ping(std::uint8_t id, std::span<std::byte> out) noexcept;
// Answered with `length` bytes from `address`.
Packet Read(std::uint8_t id, std::uint8_t address, std::uint8_t length,
            std::span<std::byte> out) noexcept;
// Answered with an empty status; not at all when broadcast.
Packet Write(std::uint8_t id, std::uint8_t address, std::span<const std::byte> data,
             std::span<std::byte> out) noexcept;
// Not answered; takes some 800 ms. Torque has to be off.
Packet Reboot(std::uint8_t id, std::span<std::byte> out) noexcept;
// Answered by each servo in the order of the ids; by STS and SMS, and some of the SCS.
Packet SyncRead(std::uint8_t address, std::uint8_t length, std::span<const std::uint8_t> ids,
                std::span<std::byte> out) noexcept;

// A Sync Write, servo by servo: the same registers of many, no reply. The length is one byte: with
// seven bytes of data, 31 servos fill a packet, and the next one belongs into another.
class SyncWrite {
 public:
  // `length` bytes from `address` for every servo.
  SyncWrite(std::uint8_t address, std::uint8_t length, std::span<std::byte> out) noexcept;
  // False, with nothing changed: the packet is full, data.size() is not the length, or the id is
  // above kMaxId.
  [[nodiscard]] bool Add(std::uint8_t id, std::span<const std::byte> data) noexcept;
  bool empty() const noexcept { return size_ == kHead; }
  // kOutOfRange when no servo was added; kFull when out cannot hold even an empty packet.
  Packet Finish() noexcept;

 private:
  static constexpr std::size_t kHead = 7;  // FF FF FE length 83 address n

  std::span<std::byte> out_;
  std::size_t size_ = kHead;
  std::uint8_t address_;
  std::uint8_t length_;
};

}  // namespace facewire::wire::feetech

#endif  // FACEWIRE_CORE_WIRE_FEETECH_PACKET_H_
