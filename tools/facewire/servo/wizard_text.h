#ifndef FACEWIRE_TOOLS_FACEWIRE_SERVO_WIZARD_TEXT_H_
#define FACEWIRE_TOOLS_FACEWIRE_SERVO_WIZARD_TEXT_H_

#include <cstdint>
#include <filesystem>
#include <string>

#include "core/rig/rig.h"
#include "tools/facewire/servo/jog.h"

// What the wizard writes, as text.
namespace facewire::tools {

// One servo as its builder has shown it.
struct ShownServo {
  std::string name;
  std::string bus;
  std::uint8_t id = 0;
  const Channel* channel = nullptr;  // what moves it; none: only a hand
  // With a channel, the first is where the channel is at its least, the second at its most.
  Marks marks;
  float max_speed_per_s = 0;
  std::string unit;
};

// A [[servo]] of rig.toml. All three marks have to be there.
std::string ServoBlock(const ShownServo& servo);
// The rig's channels with their ranges, in columns.
std::string ChannelTable(const Rig& rig);
// "jaw.pitch" as the name of a servo: "jaw_pitch".
std::string ServoName(const std::string& channel);

// What LoadConfig says of `text` as the configuration `file`. Throws BadInput.
void CheckConfigText(const std::filesystem::path& file, const std::string& text);

}  // namespace facewire::tools

#endif  // FACEWIRE_TOOLS_FACEWIRE_SERVO_WIZARD_TEXT_H_
