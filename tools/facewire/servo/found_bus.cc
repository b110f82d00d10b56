#include "tools/facewire/servo/found_bus.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <span>

namespace facewire::tools {
namespace {

struct Model {
  std::uint16_t number;
  const char* name;
};

// Model Number of the control tables, emanual.robotis.com/docs/en/dxl/x/.
constexpr std::array kDynamixels = {
    Model{1000, "XH430-W350"},  Model{1010, "XH430-W210"},  Model{1020, "XM430-W350"},
    Model{1030, "XM430-W210"},  Model{1040, "XH430-V350"},  Model{1050, "XH430-V210"},
    Model{1060, "XL430-W250"},  Model{1070, "XC430-W150"},  Model{1080, "XC430-W240"},
    Model{1090, "2XL430-W250"}, Model{1100, "XH540-W270"},  Model{1110, "XH540-W150"},
    Model{1120, "XM540-W270"},  Model{1130, "XM540-W150"},  Model{1140, "XH540-V270"},
    Model{1150, "XH540-V150"},  Model{1160, "2XC430-W250"}, Model{1170, "XW540-T260"},
    Model{1180, "XW540-T140"},  Model{1190, "XL330-M077"},  Model{1200, "XL330-M288"},
    Model{1210, "XC330-T181"},  Model{1220, "XC330-T288"},  Model{1230, "XC330-M181"},
    Model{1240, "XC330-M288"}};

// Bytes 3 and 4 of the memory, low first, as owners of these servos have read them.
constexpr std::array kFeetechs = {Model{0x0309, "STS3215"}, Model{0x0B09, "STS3250"},
                                  Model{0x0405, "SC09"}};

std::string NameOf(std::span<const Model> models, std::uint16_t number,
                   const std::string& unknown) {
  const auto found = std::ranges::find(models, number, &Model::number);
  return found == models.end() ? unknown : found->name;
}

std::string Padded(std::string text, std::size_t width) {
  text.resize(std::max(width, text.size()), ' ');
  return text;
}

std::string Printed(const char* format, double value) {
  std::array<char, 32> text;
  std::snprintf(text.data(), text.size(), format, value);
  return text.data();
}

std::string Row(const FoundServo& servo) {
  std::string row = "    " + Padded(std::to_string(servo.id), 5) + Padded(servo.model, 16);
  row += Padded(servo.position ? std::to_string(*servo.position) : "-", 10);
  row += Padded(servo.temperature_c ? Printed("%.0f C", *servo.temperature_c) : "-", 13);
  return row + (servo.voltage_v ? Printed("%.1f V", *servo.voltage_v) : "-") + "\n";
}

// A name that stays when the device comes back under another number, where udev keeps one.
std::string StablePort(const std::string& port) {
  for (const char* folder : {"/dev/facewire", "/dev/serial/by-id"}) {
    std::error_code ignored;
    for (const auto& link : std::filesystem::directory_iterator(folder, ignored)) {
      if (std::filesystem::equivalent(link.path(), port, ignored)) return link.path().string();
    }
  }
  return std::filesystem::absolute(port).lexically_normal().string();
}

}  // namespace

const char* KindOf(Protocol protocol) {
  switch (protocol) {
    case Protocol::kReceiver:
      return "receiver";
    case Protocol::kMaestro:
      return "maestro";
    case Protocol::kDynamixel:
      return "dynamixel";
    case Protocol::kFeetech:
      return "feetech";
  }
  return "";
}

const char* Name(Protocol protocol) {
  switch (protocol) {
    case Protocol::kReceiver:
      return "facewire receiver";
    case Protocol::kMaestro:
      return "Pololu Maestro";
    case Protocol::kDynamixel:
      return "Dynamixel";
    case Protocol::kFeetech:
      return "Feetech";
  }
  return "";
}

std::string Describe(const FoundBus& bus) {
  std::string text = bus.port + ": " + Name(bus.protocol) + " at " + std::to_string(bus.baud) +
                     " baud" + (bus.about.empty() ? "" : ", " + bus.about) + "\n";
  if (bus.servos.empty()) return text;
  text += "    id   model           position  temperature  voltage\n";
  for (const FoundServo& servo : bus.servos) text += Row(servo);
  return text;
}

std::string BusBlock(const FoundBus& bus, const std::string& name) {
  std::string text = "[[bus]]\nname = \"" + name + "\"\nkind = \"" + KindOf(bus.protocol) + "\"\n";
  text += "port = \"serial:" + StablePort(bus.port) + "\"\n";
  text += "baud = " + std::to_string(bus.baud) + "\n";
  if (bus.crc) text += "crc = true\n";
  if (bus.protocol == Protocol::kFeetech) {
    text += std::string("series = \"") + (bus.scs ? "scs" : "sts") + "\"\n";
  }
  return text;
}

std::string DynamixelModel(std::uint16_t number) {
  return NameOf(kDynamixels, number, "model " + std::to_string(number));
}

std::string FeetechModel(std::uint16_t number, bool scs) {
  const std::string numbers = std::to_string(number & 0xFFU) + "." + std::to_string(number >> 8U);
  return NameOf(kFeetechs, number, (scs ? "SCS " : "STS ") + numbers);
}

}  // namespace facewire::tools
