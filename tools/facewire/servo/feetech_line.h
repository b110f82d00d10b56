#ifndef FACEWIRE_TOOLS_FACEWIRE_SERVO_FEETECH_LINE_H_
#define FACEWIRE_TOOLS_FACEWIRE_SERVO_FEETECH_LINE_H_

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/bus/feetech_bus.h"
#include "tools/facewire/servo/line.h"

namespace facewire::tools {

// Single questions to Feetech servos, one after the other, for what an operator wants to know or
// set. Moving them is core/bus's.
class FeetechLine {
 public:
  explicit FeetechLine(Line& line) noexcept : line_(line) {}

  struct Servo {
    bus::FeetechSeries series = bus::FeetechSeries::kSts;
    std::uint16_t model = 0;  // low byte: the major number
  };
  // nullopt: nobody has this id. Reads instead of pinging: an adapter that echoes answers every
  // ping itself, and a read of two bytes too, but not one of three.
  std::optional<Servo> Find(std::uint8_t id);
  // As they are in its memory; nullopt: no answer.
  std::optional<std::vector<std::byte>> Bytes(std::uint8_t id, wire::feetech::Register what);
  // One or two bytes in the series' order; nullopt: no answer.
  std::optional<std::uint16_t> Read(std::uint8_t id, wire::feetech::Register what,
                                    bus::FeetechSeries series);
  // Sends a packet that `answerer` acknowledges; whether it did.
  bool Ask(std::uint8_t answerer, std::span<const std::byte> packet);

 private:
  Line& line_;
};

}  // namespace facewire::tools

#endif  // FACEWIRE_TOOLS_FACEWIRE_SERVO_FEETECH_LINE_H_
