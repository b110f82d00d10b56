#include "tools/facewire/servo/words.h"

#include <array>

#include "core/wire/maestro/maestro.h"
#include "tools/facewire/servo/open.h"

namespace facewire::tools {
namespace {

using bus::Setting;

std::string SerialErrorsText(std::uint16_t errors) {
  std::string text;
  for (unsigned bit = 0; bit < 16; ++bit) {
    if ((errors >> bit & 1U) == 0) continue;
    text += (text.empty() ? "" : ", ") +
            std::string(Name(static_cast<wire::maestro::Error>(1U << bit)));
  }
  return text.empty() ? "none" : text;
}

std::string ValueText(Setting setting, std::int32_t value) {
  switch (setting) {
    case Setting::kShutdown:
      return FaultsText(static_cast<bus::HardwareFaults>(value));
    case Setting::kReturnDelay:
      return std::to_string(value) + " us";
    case Setting::kProfileUnit:
      return value != 0 ? "time" : "speed";
    case Setting::kLock:
      return value != 0 ? "closed" : "open";
    case Setting::kPulseRange:
      return std::to_string(value / 4) + " us";
    case Setting::kSerialErrors:
      return SerialErrorsText(static_cast<std::uint16_t>(value));
    default:
      return std::to_string(value);
  }
}

// As the command line takes it.
std::string Argument(Setting setting, std::int32_t value) {
  if (setting == Setting::kReturnDelay || setting == Setting::kPulseRange)
    return std::to_string(value);
  std::string text;
  for (const char c : ValueText(setting, value)) {
    if (c != ' ') text += c;
  }
  return text;
}

}  // namespace

std::string FaultsText(bus::HardwareFaults faults) {
  std::string text;
  for (unsigned bit = 0; bit < 6; ++bit) {
    if ((faults >> bit & 1U) == 0) continue;
    text +=
        (text.empty() ? "" : ", ") + std::string(Name(static_cast<bus::HardwareFault>(1U << bit)));
  }
  return text.empty() ? "none" : text;
}

std::string_view SettingWord(Setting setting) {
  switch (setting) {
    case Setting::kOperatingMode:
      return "mode";
    case Setting::kMinPosition:
      return "min-position";
    case Setting::kMaxPosition:
      return "max-position";
    case Setting::kShutdown:
      return "shutdown";
    case Setting::kReturnDelay:
      return "return-delay";
    case Setting::kProfileUnit:
      return "profile-unit";
    case Setting::kLock:
      return "lock";
    default:
      return "";
  }
}

std::string FindingText(const bus::Finding& finding, std::string_view servo,
                        const app::ServoBusConfig& bus, const std::string& config) {
  std::string text = std::string(Name(finding.setting)) + " is " +
                     ValueText(finding.setting, finding.found) + ", should be " +
                     ValueText(finding.setting, finding.wanted);
  if (finding.refused) text += " (it is left limp until then)";
  const std::string_view word = SettingWord(finding.setting);
  if (!word.empty()) {
    return text + ": facewire servo set " + std::string(servo) + " " + std::string(word) + " " +
           Argument(finding.setting, finding.wanted) +
           (config == kUsualConfig ? "" : " --config " + config);
  }
  if (finding.setting == Setting::kPulseRange && bus.kind == app::BusKind::kMaestro) {
    return text + ": widen the channel's Min and Max in Pololu's Maestro Control Center";
  }
  return text;
}

std::string BusText(const bus::BusStatus& status, const app::ServoBusConfig& bus) {
  const std::string name =
      "bus " + bus.name + " (" + bus.port + ", " + std::to_string(bus.baud) + " baud): ";
  if (status.serial_errors != 0) {
    return name + "the controller reports " + SerialErrorsText(status.serial_errors);
  }
  switch (status.fault) {
    case bus::BusFault::kNobodyAnswers:
      return name +
             "nobody answers; are the servos powered, is this the rate? facewire servo find " +
             bus.port.substr(bus.port.find(':') + 1);
    case bus::BusFault::kEcho:
      return name +
             "the adapter gives back what is sent; wire it half-duplex, with its receiver "
             "off while it sends";
    case bus::BusFault::kSettings:
      return name + "settings of every servo make it unsafe to move";
    default:
      return "";
  }
}

}  // namespace facewire::tools
