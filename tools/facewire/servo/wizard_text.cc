#include "tools/facewire/servo/wizard_text.h"

#include <algorithm>
#include <array>
#include <cstdio>

#include "app/config.h"
#include "tools/facewire/servo/rig_text.h"
#include "tools/facewire/servo/temporary_file.h"

namespace facewire::tools {
namespace {

std::string Number(double value) {
  std::array<char, 32> text;
  std::snprintf(text.data(), text.size(), "%g", value);
  return text.data();
}

std::string UnitOf(const Channel& channel) {
  switch (channel.kind) {
    case ChannelKind::kParameter:
      return "";
    case ChannelKind::kPositionX:
    case ChannelKind::kPositionY:
    case ChannelKind::kPositionZ:
      return " cm";
    default:
      return " deg";
  }
}

}  // namespace

std::string ServoBlock(const ShownServo& servo) {
  const float first = *servo.marks.first;
  const float second = *servo.marks.second;
  std::string text = "\n[[servo]]\nname = \"" + servo.name + "\"\nbus = \"" + servo.bus +
                     "\"\nid = " + std::to_string(servo.id) + "\n";
  if (servo.channel != nullptr) {
    const Channel& channel = *servo.channel;
    text += "from = { \"" + std::string(channel.name.view()) + "\" = 1 }\n";
    text += "map = [[" + Number(channel.min) + ", " + PositionText(first) + "], [" +
            Number(channel.max) + ", " + PositionText(second) + "]]";
    text += channel.kind == ChannelKind::kParameter
                ? "\n"
                : "  #" + UnitOf(channel) + " to " + servo.unit + "\n";
  } else {
    text += "min = " + PositionText(std::min(first, second)) + "\n";
    text += "max = " + PositionText(std::max(first, second)) + "\n";
  }
  text += "neutral = " + PositionText(*servo.marks.neutral) + "\n";
  return text + "max_speed = " + PositionText(servo.max_speed_per_s) + "  # " + servo.unit +
         " a second; less is calmer\n";
}

std::string ChannelTable(const Rig& rig) {
  constexpr std::size_t kWidth = 38;
  std::string text;
  std::string line;
  for (const Channel& channel : rig.channels) {
    std::string cell = "  " + std::string(channel.name.view()) + " " + Number(channel.min) + ".." +
                       Number(channel.max) + UnitOf(channel);
    cell.resize(std::max(kWidth, cell.size() + 1), ' ');
    line += cell;
    if (line.size() < 2 * kWidth) continue;
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + "\n";
    line.clear();
  }
  line.erase(line.find_last_not_of(' ') + 1);
  return line.empty() ? text : text + line + "\n";
}

std::string ServoName(const std::string& channel) {
  std::string name = channel;
  std::ranges::replace(name, '.', '_');
  return name;
}

void CheckConfigText(const std::filesystem::path& file, const std::string& text) {
  const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
  CheckAsFile(folder, text, file.string(),
              [](const std::filesystem::path& copy) { (void)app::LoadConfig(copy); });
}

}  // namespace facewire::tools
