#ifndef FACEWIRE_TOOLS_FACEWIRE_SERVO_DYNAMIXEL_LINE_H_
#define FACEWIRE_TOOLS_FACEWIRE_SERVO_DYNAMIXEL_LINE_H_

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/wire/dynamixel/registers.h"
#include "core/wire/dynamixel/status.h"
#include "tools/facewire/servo/line.h"

namespace facewire::tools {

// Single questions to Dynamixels, one after the other, for what an operator wants to know or set.
// Moving them is core/bus's.
class DynamixelLine {
 public:
  explicit DynamixelLine(Line& line) noexcept : line_(line) {}

  struct Servo {
    std::uint8_t id = 0;
    std::uint16_t model = 0;
    std::uint8_t firmware = 0;
  };
  // All that answer a broadcast, by id; takes 0.8 s.
  std::vector<Servo> PingAll();
  // nullopt: no answer, or the servo has no such register.
  std::optional<std::uint32_t> Read(std::uint8_t id, wire::dynamixel::Register what);
  // Sends a packet that is answered with an empty status. nullopt: no answer.
  std::optional<wire::dynamixel::StatusError> Ask(std::uint8_t id,
                                                  std::span<const std::byte> packet);

 private:
  Line& line_;
};

}  // namespace facewire::tools

#endif  // FACEWIRE_TOOLS_FACEWIRE_SERVO_DYNAMIXEL_LINE_H_
