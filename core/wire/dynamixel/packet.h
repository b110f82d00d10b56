#ifndef FACEWIRE_CORE_WIRE_DYNAMIXEL_PACKET_H_
#define FACEWIRE_CORE_WIRE_DYNAMIXEL_PACKET_H_

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/base/result.h"

// Instruction packets of Dynamixel Protocol 2.0 (emanual.robotis.com/docs/en/dxl/protocol2/).
// README.md here is the specification.
namespace facewire::wire::dynamixel {

inline constexpr std::uint8_t kMaxId = 252;
inline constexpr std::uint8_t kBroadcast = 0xFE;
// Room for one packet with 384 bytes of parameters, the worst stuffing included: Sync Write of five
// bytes for each of 64 servos fits.
inline constexpr std::size_t kMaxPacketBytes = 544;

enum class Instruction : std::uint8_t {
  kPing = 0x01,
  kRead = 0x02,
  kWrite = 0x03,
  kReboot = 0x08,
  kStatus = 0x55,
  kSyncRead = 0x82,
  kSyncWrite = 0x83,
};

// CRC-16: polynomial 0x8005, highest bit first, starts at 0, sent low byte first.
std::uint16_t Crc16(std::span<const std::byte> bytes) noexcept;

// Every function writes one packet to the beginning of `out` and returns it. kOutOfRange: an id
// that is neither 0 to kMaxId nor kBroadcast (where that makes sense), no data or no ids; kFull:
// out is too small.
using Packet = Result<std::span<const std::byte>>;

// Answered with the model (two bytes) and the firmware; by all servos in turn when broadcast.
Packet Ping(std::uint8_t id, std::span<std::byte> out) noexcept;
// Answered with `length` bytes from `address`.
Packet Read(std::uint8_t id, std::uint16_t address, std::uint16_t length,
            std::span<std::byte> out) noexcept;
// Answered with an empty status; not at all when broadcast.
Packet Write(std::uint8_t id, std::uint16_t address, std::span<const std::byte> data,
             std::span<std::byte> out) noexcept;
// Clears hardware errors; the servo is away for some 100 ms.
Packet Reboot(std::uint8_t id, std::span<std::byte> out) noexcept;
// Answered by each servo, in the order of the ids.
Packet SyncRead(std::uint16_t address, std::uint16_t length, std::span<const std::uint8_t> ids,
                std::span<std::byte> out) noexcept;

// Puts together one packet byte by byte, stuffed as it goes. For use by the functions above and by
// who needs an instruction that they have not.
class PacketWriter {
 public:
  PacketWriter(std::uint8_t id, Instruction instruction, std::span<std::byte> out) noexcept;
  void Add(std::uint8_t value) noexcept;
  void Add16(std::uint16_t value) noexcept;  // low byte first
  void Add(std::span<const std::byte> bytes) noexcept;
  // kFull when out was too small for all of it.
  Packet Finish() noexcept;

 private:
  void Put(std::uint8_t value) noexcept;

  std::span<std::byte> out_;
  std::size_t size_ = 0;
  unsigned run_ = 0;  // how much of FF FF FD the last bytes are
};

// A Sync Write, servo by servo: the same registers of many, no reply. A servo that does not fit
// (Add gives false) belongs into the next packet.
class SyncWrite {
 public:
  // `length` bytes from `address` for every servo.
  SyncWrite(std::uint16_t address, std::uint16_t length, std::span<std::byte> out) noexcept;
  // False, with nothing changed: the packet is full, data.size() is not the length, or the id is
  // above kMaxId.
  [[nodiscard]] bool Add(std::uint8_t id, std::span<const std::byte> data) noexcept;
  bool empty() const noexcept { return empty_; }
  // kOutOfRange when no servo was added; kFull when out cannot hold even an empty packet.
  Packet Finish() noexcept;

 private:
  PacketWriter writer_;
  std::size_t left_;  // bytes, before stuffing
  std::uint16_t length_;
  bool empty_ = true;
};

}  // namespace facewire::wire::dynamixel

#endif  // FACEWIRE_CORE_WIRE_DYNAMIXEL_PACKET_H_
