#ifndef FACEWIRE_CORE_WIRE_DYNAMIXEL_STATUS_H_
#define FACEWIRE_CORE_WIRE_DYNAMIXEL_STATUS_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/base/result.h"

namespace facewire::wire::dynamixel {

// Why a servo did not do as it was told: one number, not bits.
enum class StatusError : std::uint8_t {
  kNone = 0,
  kFailed = 1,
  kInstruction = 2,
  kCrc = 3,
  kRange = 4,   // value outside what the register allows
  kLength = 5,  // fewer bytes than the register has
  kLimit = 6,   // value outside a limit that another register sets
  kAccess = 7,  // read-only, not there, or in EEPROM while torque is on
};
const char* Name(StatusError error) noexcept;

// One status packet.
struct Status {
  std::uint8_t id = 0;
  StatusError error = StatusError::kNone;  // a number unknown here reads as kFailed
  bool alert = false;                      // hardware error: its register says which
  std::span<const std::byte> parameters;   // without stuffing; until the next call of Next
};

// Parameters of the longest status packet that is read, stuffing included.
inline constexpr std::size_t kMaxStatusParameters = 256;

struct ReaderStats {
  std::uint64_t packets = 0;       // delivered
  std::uint64_t instructions = 0;  // sound packets that are no status: the line echoes
  std::uint64_t damaged = 0;       // packets that began and did not end well
};

// Finds status packets in a stream of bytes, however it is cut. A header cannot appear inside a
// sound packet (that is what stuffing is for), so wherever one appears a packet begins: whatever
// came before, the first sound packet is delivered with its last byte.
class StatusReader {
 public:
  // Takes bytes off the front of `bytes` up to the end of the next packet. kNotReady: all were
  // taken and no packet ended. Packets that are damaged or no status are skipped, and counted.
  Result<Status> Next(std::span<const std::byte>& bytes) noexcept;
  // Forgets a packet that has begun; for after a time-out.
  void Reset() noexcept;

  const ReaderStats& stats() const noexcept { return stats_; }

 private:
  // Whether the packet is complete with this byte and sound.
  bool Take(std::uint8_t byte) noexcept;
  bool Unstuff() noexcept;

  std::array<std::byte, 4 + 3 + 2 + kMaxStatusParameters + 2> packet_{};
  std::size_t size_ = 0;        // bytes of the packet so far; 0: none has begun
  std::size_t total_ = 0;       // bytes it will have; 0: not known yet
  std::uint32_t window_ = 0;    // the last four bytes
  std::size_t parameters_ = 0;  // of the packet that was delivered
  ReaderStats stats_;
};

}  // namespace facewire::wire::dynamixel

#endif  // FACEWIRE_CORE_WIRE_DYNAMIXEL_STATUS_H_
