#include "tools/facewire/servo/feetech_line.h"

#include <array>
#include <chrono>

#include "core/wire/feetech/packet.h"
#include "core/wire/feetech/registers.h"
#include "core/wire/feetech/status.h"

namespace facewire::tools {
namespace {

namespace ft = wire::feetech;
using std::chrono::milliseconds;

// USB adapters hold bytes back for up to 16 ms.
constexpr milliseconds kReply(20);
// EEPROM takes some milliseconds to be written.
constexpr milliseconds kWritten(60);

// The order of two-byte values (1: high byte first, as SCS servos have it), then the model's two
// numbers.
constexpr ft::Register kIdentity{2, 3};

}  // namespace

std::optional<std::vector<std::byte>> FeetechLine::Bytes(std::uint8_t id, ft::Register what) {
  std::array<std::byte, ft::kMaxPacketBytes> buffer;
  std::optional<std::vector<std::byte>> answer;
  ft::StatusReader reader;
  (void)reader.Expect(std::span(&id, 1), what.bytes);
  line_.Send(*ft::Read(id, what.address, what.bytes, buffer));
  line_.Receive(kReply, [&](std::span<const std::byte> bytes) {
    if (const auto status = reader.Next(bytes)) {
      answer.emplace(status->parameters.begin(), status->parameters.end());
    }
    return answer.has_value();
  });
  return answer;
}

std::optional<FeetechLine::Servo> FeetechLine::Find(std::uint8_t id) {
  const auto bytes = Bytes(id, kIdentity);
  if (!bytes) return std::nullopt;
  const bool high_first = (*bytes)[0] == std::byte{1};
  return Servo{.series = high_first ? bus::FeetechSeries::kScs : bus::FeetechSeries::kSts,
               .model = ft::Get16(std::span(*bytes).subspan(1), ft::ByteOrder::kLowFirst)};
}

std::optional<std::uint16_t> FeetechLine::Read(std::uint8_t id, ft::Register what,
                                               bus::FeetechSeries series) {
  const auto bytes = Bytes(id, what);
  if (!bytes) return std::nullopt;
  if (what.bytes == 1) return std::to_integer<std::uint16_t>((*bytes)[0]);
  const bool low_first = series == bus::FeetechSeries::kSts;
  return ft::Get16(*bytes, low_first ? ft::ByteOrder::kLowFirst : ft::ByteOrder::kHighFirst);
}

bool FeetechLine::Ask(std::uint8_t answerer, std::span<const std::byte> packet) {
  ft::StatusReader reader;
  (void)reader.Expect(std::span(&answerer, 1), 0);
  line_.Send(packet);
  return line_.Receive(
      kWritten, [&](std::span<const std::byte> bytes) { return reader.Next(bytes).has_value(); });
}

}  // namespace facewire::tools
