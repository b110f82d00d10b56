#include "tools/facewire/doctor_gpio.h"

#include <grp.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <string>

#include "app/gpio_lines.h"

namespace facewire::tools {
namespace {

using hal::gpiod::ChipInfo;
using hal::gpiod::GpiodConfig;
using hal::gpiod::Library;

// What gives the user the right to open a device node.
std::string HowToBeAllowed(const std::string& path) {
  struct stat node {};
  const group* owner = ::stat(path.c_str(), &node) == 0 ? ::getgrgid(node.st_gid) : nullptr;
  if (owner == nullptr || owner->gr_gid == 0 || (node.st_mode & S_IWGRP) == 0) {
    return "only root may: install facewire's udev rules (60-facewire.rules), then sudo udevadm "
           "trigger --subsystem-match=gpio";
  }
  return std::string("sudo usermod -aG ") + owner->gr_name + " $USER, then log in again";
}

Finding CheckChip(Library& library, const std::string& path) {
  const auto chip = library.Describe(path);
  const int error = errno;
  if (chip) {
    const auto used = std::ranges::count_if(chip->lines, &hal::gpiod::LineInfo::used);
    return {"GPIO chip", Verdict::kOk,
            path + ": \"" + chip->label + "\", " + std::to_string(chip->lines.size()) + " lines, " +
                std::to_string(used) + " in use",
            ""};
  }
  if (error == EACCES || error == EPERM) {
    return {"GPIO chip", Verdict::kWarn, path + ": no permission", HowToBeAllowed(path)};
  }
  return {"GPIO chip", Verdict::kWarn, path + ": " + std::strerror(error), "dmesg may tell more"};
}

Finding CheckLine(Library& library, const char* key, const GpiodConfig& config) {
  std::string reason;
  const auto place = hal::gpiod::FindLine(library, config.name, reason);
  if (!place) {
    const bool allowed = place.error() != Errc::kPermission;
    return {key, Verdict::kFail, reason,
            allowed ? "correct [gpio] " + std::string(key) + "; gpioinfo lists all lines"
                    : "see the GPIO chip above"};
  }
  if (!place->line.used) return {key, Verdict::kOk, place->text, ""};
  if (place->line.consumer == hal::gpiod::kConsumer) {
    return {key, Verdict::kOk, place->text + ", held by facewired", ""};
  }
  return {key, Verdict::kFail, place->text + " is in use by \"" + place->line.consumer + "\"",
          "choose another line, or free that one: a program, or a dtoverlay of config.txt"};
}

}  // namespace

std::vector<Finding> CheckGpio(const app::GpioConfig* gpio, Library& library) {
  std::vector<Finding> findings;
  const std::vector<std::string> chips = library.Chips();
  if (chips.empty()) {
    findings.push_back({"GPIO chip", Verdict::kOk, "none; needed for switches and lamps only", ""});
  }
  for (const std::string& path : chips) findings.push_back(CheckChip(library, path));
  if (gpio == nullptr) return findings;
  for (const auto& [key, config] : app::GpioConfigs(*gpio)) {
    if (!config.name.line.empty()) findings.push_back(CheckLine(library, key, config));
  }
  return findings;
}

}  // namespace facewire::tools
