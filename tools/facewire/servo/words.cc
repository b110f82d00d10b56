#include "tools/facewire/servo/words.h"

#include "app/animatronic/servo_words.h"
#include "tools/facewire/servo/open.h"

namespace facewire::tools {

using bus::Setting;

std::string FindingText(const bus::Finding& finding, std::string_view servo,
                        const app::ServoBusConfig& bus, const std::string& config) {
  std::string text = std::string(Name(finding.setting)) + " is " +
                     app::SettingWords(finding.setting, finding.found).data() + ", should be " +
                     app::SettingWords(finding.setting, finding.wanted).data();
  if (finding.refused) text += " (it is left limp until then)";
  const std::string_view word = app::SettingWord(finding.setting);
  if (!word.empty()) {
    return text + ": facewire servo set " + std::string(servo) + " " + std::string(word) + " " +
           app::SettingArgument(finding.setting, finding.wanted).data() +
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
    return name + "the controller reports " + app::SerialErrorWords(status.serial_errors).data();
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
