#ifndef FACEWIRE_CORE_WIRE_FEETECH_STATUS_H_
#define FACEWIRE_CORE_WIRE_FEETECH_STATUS_H_

#include <array>
#include <bitset>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/base/result.h"

namespace facewire::wire::feetech {

// One status packet.
struct Status {
  std::uint8_t id = 0;
  std::uint8_t errors = 0;                // bits of ServoError (registers.h)
  std::span<const std::byte> parameters;  // until the next call
};

// Parameters of the longest status packet that is read.
inline constexpr std::size_t kMaxStatusParameters = 96;

struct ReaderStats {
  std::uint64_t packets = 0;       // delivered
  std::uint64_t instructions = 0;  // packets to everybody: the line echoes what is sent
  std::uint64_t dropped = 0;       // bytes that belong to no packet that was asked for
};

// Finds the replies to one question in a stream of bytes, however it is cut. The protocol has no
// mark that cannot appear inside a packet and only a sum of eight bits against damage, so the
// reader has to know who is asked and for how much: then whatever came before, the first sound
// reply is delivered with its last byte.
class StatusReader {
 public:
  // From now on, one reply of `parameters` bytes from each of these is taken; what was left of
  // earlier bytes is dropped. kOutOfRange: more parameters than kMaxStatusParameters; nothing is
  // changed.
  Result<> Expect(std::span<const std::uint8_t> ids, std::size_t parameters) noexcept;
  // Nothing is taken any more.
  void Forget() noexcept;

  // Takes bytes off the front of `bytes` up to the end of the next reply. kNotReady: all were taken
  // and no reply ended.
  Result<Status> Next(std::span<const std::byte>& bytes) noexcept;

  const ReaderStats& stats() const noexcept { return stats_; }

 private:
  // What the buffer begins with.
  enum class Front : std::uint8_t { kNothing, kPart, kPacket };
  Front Look() noexcept;
  void Drop(std::size_t count) noexcept;

  static constexpr std::size_t kFrame = 6;  // FF FF id length errors ... sum

  std::array<std::byte, kFrame + kMaxStatusParameters> buffer_{};
  std::size_t size_ = 0;
  std::size_t taken_ = 0;  // of the buffer's front: the packet delivered last
  std::size_t parameters_ = 0;
  std::bitset<256> expected_;
  ReaderStats stats_;
};

}  // namespace facewire::wire::feetech

#endif  // FACEWIRE_CORE_WIRE_FEETECH_STATUS_H_
