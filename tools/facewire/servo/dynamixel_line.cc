#include "tools/facewire/servo/dynamixel_line.h"

#include <algorithm>
#include <array>
#include <chrono>

#include "core/wire/dynamixel/packet.h"

namespace facewire::tools {
namespace {

namespace dxl = wire::dynamixel;
using std::chrono::milliseconds;

// A broadcast is answered by each id in a slot of 3 ms (the maker's SDK waits as long); USB
// adapters hold bytes back for up to 16 ms.
constexpr milliseconds kAdapter(20);
constexpr milliseconds kPingAll = 3 * milliseconds(dxl::kMaxId + 1) + kAdapter;
// EEPROM takes some milliseconds to be written, and 16 bytes at 9600 baud take 17 ms.
constexpr milliseconds kReply = kAdapter + milliseconds(40);

constexpr std::size_t kPingParameters = 3;  // model, firmware

using Packet = std::array<std::byte, dxl::kMaxPacketBytes>;

std::uint32_t Number(std::span<const std::byte> bytes) {
  std::uint32_t value = 0;
  for (std::size_t i = bytes.size(); i-- > 0;) {
    value = value << 8U | std::to_integer<std::uint32_t>(bytes[i]);
  }
  return value;
}

}  // namespace

std::vector<DynamixelLine::Servo> DynamixelLine::PingAll() {
  Packet buffer;
  std::vector<Servo> found;
  dxl::StatusReader reader;
  line_.Send(*dxl::Ping(dxl::kBroadcast, buffer));
  line_.Receive(kPingAll, [&](std::span<const std::byte> bytes) {
    while (const auto status = reader.Next(bytes)) {
      if (status->parameters.size() < kPingParameters) continue;
      found.push_back({.id = status->id,
                       .model = static_cast<std::uint16_t>(Number(status->parameters.first(2))),
                       .firmware = std::to_integer<std::uint8_t>(status->parameters[2])});
    }
    return false;  // nobody knows who else is there
  });
  std::ranges::sort(found, {}, &Servo::id);
  return found;
}

std::optional<std::uint32_t> DynamixelLine::Read(std::uint8_t id, dxl::Register what) {
  Packet buffer;
  std::optional<std::uint32_t> value;
  dxl::StatusReader reader;
  line_.Send(*dxl::Read(id, what.address, what.bytes, buffer));
  line_.Receive(kReply, [&](std::span<const std::byte> bytes) {
    while (const auto status = reader.Next(bytes)) {
      if (status->id != id) continue;
      if (status->parameters.size() == what.bytes) value = Number(status->parameters);
      return true;
    }
    return false;
  });
  return value;
}

std::optional<dxl::StatusError> DynamixelLine::Ask(std::uint8_t id,
                                                   std::span<const std::byte> packet) {
  std::optional<dxl::StatusError> error;
  dxl::StatusReader reader;
  line_.Send(packet);
  line_.Receive(kReply, [&](std::span<const std::byte> bytes) {
    while (const auto status = reader.Next(bytes)) {
      if (status->id != id) continue;
      error = status->error;
      return true;
    }
    return false;
  });
  return error;
}

}  // namespace facewire::tools
