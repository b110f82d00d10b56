#ifndef FACEWIRE_CORE_WIRE_DECODER_H_
#define FACEWIRE_CORE_WIRE_DECODER_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "core/base/capacity.h"
#include "core/base/result.h"
#include "core/wire/message.h"

namespace facewire::wire {

// What came over one direction of a line. Every piece between two delimiters adds to exactly one of
// frames ... overflows (or to none, when it is empty or the tail of a frame that began before the
// decoder).
struct LinkStats {
  std::uint64_t frames = 0;       // delivered messages
  std::uint64_t unknown = 0;      // sound frames of a type that this program does not know
  std::uint64_t versions = 0;     // sound frames of another protocol version
  std::uint64_t malformed = 0;    // sound frames whose payload is too short or breaks a rule
  std::uint64_t crc_errors = 0;   // damaged on the way
  std::uint64_t cobs_errors = 0;  // a COBS block runs past the delimiter: bytes missing
  std::uint64_t truncated = 0;    // too short for a header and a CRC
  std::uint64_t overflows = 0;    // longer than any frame: a delimiter is missing
  std::uint64_t lost = 0;  // frames that never came or came damaged, from the gaps in the numbers
  std::uint64_t restarts = 0;  // of the sender, seen from the numbers
  std::uint64_t resyncs = 0;   // times that a sound frame followed damage

  std::uint64_t Damaged() const noexcept {
    return crc_errors + cobs_errors + truncated + overflows;
  }
};

struct Received {
  std::uint16_t sequence = 0;
  Message message;
};

// Finds the messages in a stream of bytes, however it is cut into pieces. Whatever arrives, the
// first sound frame after it is delivered. Fixed memory (kMaxWirePayload bytes), allocates nothing.
//
//   std::span<const std::byte> rest = what was read;
//   for (;;) {
//     const auto received = decoder.Next(rest);
//     if (received) { use *received; }
//     else if (received.error() == Errc::kNotReady) { break; }  // read more
//   }                                                           // other errors: counted, go on
class Decoder {
 public:
  // Takes bytes off the front of `bytes` up to the end of the next frame. kNotReady: all were taken
  // and no frame ended. Otherwise the frame that ended is dropped, and counted: kCorrupt
  // (crc_errors, cobs_errors), kTruncated (truncated), kFull (overflows), kVersion (versions),
  // kUnsupported (unknown), kInvalidArgument (malformed).
  Result<Received> Next(std::span<const std::byte>& bytes) noexcept;

  const LinkStats& stats() const noexcept { return stats_; }

 private:
  void Append(std::byte byte) noexcept;
  void Take(std::byte byte) noexcept;
  Result<Received> Finish() noexcept;
  Result<Received> Check(std::span<const std::byte> checked) noexcept;
  void CountSequence(std::uint16_t sequence) noexcept;

  std::array<std::byte, kMaxWirePayload> buffer_{};  // without COBS
  std::size_t size_ = 0;
  std::uint8_t left_in_block_ = 0;
  bool zero_pending_ = false;  // the COBS block stands for a zero if another block follows
  bool started_ = false;       // bytes came since the last delimiter
  bool overflowed_ = false;
  bool joined_ = false;   // a delimiter was seen: what follows is a frame from its beginning
  bool damaged_ = false;  // since the last sound frame
  std::optional<std::uint16_t> last_sequence_;
  LinkStats stats_;
};

}  // namespace facewire::wire

#endif  // FACEWIRE_CORE_WIRE_DECODER_H_
