#ifndef FACEWIRE_CORE_WIRE_MAESTRO_MAESTRO_H_
#define FACEWIRE_CORE_WIRE_MAESTRO_MAESTRO_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/base/result.h"

// The serial protocol of Pololu's Maestro servo controllers, from its user's guide
// (pololu.com/docs/0J40, sections 5.c to 5.e). README.md here is the specification.
namespace facewire::wire::maestro {

inline constexpr std::size_t kMaxChannels = 24;  // of the largest model
inline constexpr std::uint16_t kMaxValue = 16383;
inline constexpr int kStepsPerMicrosecond = 4;
// Of one packet: Set Multiple Targets for all channels, Pololu protocol, CRC.
inline constexpr std::size_t kMaxPacketBytes = 3 + 2 + 2 * kMaxChannels + 1;

// How the board is set to listen. It takes both framings at any time; CRC and device number are
// settings that only its configuration program can change or show.
struct Line {
  bool pololu = false;       // framing with a device number, for several boards on one line
  std::uint8_t device = 12;  // 0 to 127
  bool crc = false;          // every packet ends with a CRC-7
};

// The bits that Get Errors answers with. Each sends all channels to their homes at once.
enum class Error : std::uint16_t {
  kSignal = 1U << 0U,          // a stop bit was missing: noise, or another rate
  kOverrun = 1U << 1U,         // bytes came faster than the board reads
  kBufferFull = 1U << 2U,      // of reception
  kCrc = 1U << 3U,             // the CRC is wrong or missing
  kProtocol = 1U << 4U,        // not a command, or cut short
  kTimeout = 1U << 5U,         // nothing came for the time set as serial timeout
  kScriptStack = 1U << 6U,     // of a script on the board: stack
  kScriptCalls = 1U << 7U,     // its calls
  kProgramCounter = 1U << 8U,  // its program counter
};
inline constexpr std::uint16_t kErrorMask = 0x1FF;
// "serial timeout"; "unknown" for anything but one single bit of Error.
const char* Name(Error error) noexcept;

// CRC-7 of the guide's section 5.d: polynomial 0x91, lowest bit first, starts at 0.
std::uint8_t Crc7(std::span<const std::byte> bytes) noexcept;

// Makes packets. Every function writes one packet to the beginning of `out` and returns it.
// kOutOfRange: a channel, a value or the device number is beyond what the packet can carry; kFull:
// out is too small (kMaxPacketBytes always suffice).
class Encoder {
 public:
  using Packet = Result<std::span<const std::byte>>;

  Encoder() noexcept = default;
  explicit Encoder(const Line& line) noexcept : line_(line) {}

  // Targets are in 0.25 us; 0 ends the pulses.
  Packet SetTarget(std::uint8_t channel, std::uint16_t target,
                   std::span<std::byte> out) const noexcept;
  // Channels first, first + 1 ...; Mini Maestro 12, 18 and 24 only: a Micro Maestro 6 takes it for
  // an error.
  Packet SetTargets(std::uint8_t first, std::span<const std::uint16_t> targets,
                    std::span<std::byte> out) const noexcept;
  // In 0.25 us per 10 ms; 0 is unlimited.
  Packet SetSpeed(std::uint8_t channel, std::uint16_t speed,
                  std::span<std::byte> out) const noexcept;
  // In 0.25 us per 10 ms per 80 ms, 0 to 255; 0 is unlimited.
  Packet SetAcceleration(std::uint8_t channel, std::uint16_t acceleration,
                         std::span<std::byte> out) const noexcept;
  Packet GetPosition(std::uint8_t channel, std::span<std::byte> out) const noexcept;
  Packet GetMovingState(std::span<std::byte> out) const noexcept;
  Packet GetErrors(std::span<std::byte> out) const noexcept;
  // Every channel to its home, as an error does.
  Packet GoHome(std::span<std::byte> out) const noexcept;

 private:
  Packet Make(std::uint8_t command, std::span<const std::byte> data,
              std::span<std::byte> out) const noexcept;
  Packet SetValue(std::uint8_t command, std::uint8_t channel, std::uint16_t value,
                  std::span<std::byte> out) const noexcept;

  Line line_;
};

// The oldest sub-protocol, of Mini SSC: no CRC, any line. value 0 to 254, 127 is the channel's
// neutral. `channel` counts from the board's Mini SSC offset. kOutOfRange, kFull.
Encoder::Packet MiniSsc(std::uint8_t channel, std::uint8_t value,
                        std::span<std::byte> out) noexcept;

// What a reply can say.
enum class Reply : std::uint8_t { kNone, kMovingState, kPosition, kErrors };

// Collects the reply to one question. Replies carry no mark of their own, neither framing nor a
// checksum, so only one question may be out at a time, and after a reply that failed to come the
// line has to be quiet for a while before the next question.
class ReplyReader {
 public:
  // A question went out; what is left of an earlier one is forgotten.
  void Expect(Reply reply) noexcept;
  // No answer is awaited any more: what comes is dropped.
  void Forget() noexcept { Expect(Reply::kNone); }
  Reply expected() const noexcept { return expected_; }

  // Takes bytes off the front of `bytes`, up to the end of the reply. kNotReady: all were taken and
  // there is no reply yet. kCorrupt: complete, but a value that no board sends (a moving state
  // above 1, unknown error bits, a position above 16383). After either, nothing is expected.
  Result<std::uint16_t> Next(std::span<const std::byte>& bytes) noexcept;

  // Bytes that came when none were expected.
  std::uint64_t stray() const noexcept { return stray_; }

 private:
  Reply expected_ = Reply::kNone;
  std::array<std::uint8_t, 2> bytes_{};
  std::size_t size_ = 0;
  std::uint64_t stray_ = 0;
};

}  // namespace facewire::wire::maestro

#endif  // FACEWIRE_CORE_WIRE_MAESTRO_MAESTRO_H_
