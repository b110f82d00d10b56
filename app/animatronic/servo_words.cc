#include "app/animatronic/servo_words.h"

#include <cstdio>

namespace facewire::app {

const char* Name(servo::Activity activity) noexcept {
  switch (activity) {
    case servo::Activity::kWaiting:
      return "waiting";
    case servo::Activity::kFollowing:
      return "following";
    case servo::Activity::kManual:
      return "manual";
    case servo::Activity::kHolding:
      return "holding";
    case servo::Activity::kEasing:
      return "easing";
    case servo::Activity::kResting:
      return "resting";
    case servo::Activity::kLimp:
      return "limp";
    case servo::Activity::kIdle:
      return "idle";
    case servo::Activity::kHot:
      return "let go";
    case servo::Activity::kStopped:
      return "stopped";
  }
  return "unknown";
}

Words FaultWords(bus::HardwareFaults faults) noexcept {
  Words words{"none"};
  std::size_t size = 0;
  for (unsigned bit = 0; bit < 6; ++bit) {
    if ((faults >> bit & 1U) == 0) continue;
    const int added =
        std::snprintf(words.data() + size, words.size() - size, "%s%s", size == 0 ? "" : ",",
                      bus::Name(static_cast<bus::HardwareFault>(1U << bit)));
    size += static_cast<std::size_t>(added);  // all six fit
  }
  return words;
}

const char* SettingWord(bus::Setting setting) noexcept {
  switch (setting) {
    case bus::Setting::kOperatingMode:
      return "mode";
    case bus::Setting::kMinPosition:
      return "min-position";
    case bus::Setting::kMaxPosition:
      return "max-position";
    case bus::Setting::kShutdown:
      return "shutdown";
    case bus::Setting::kReturnDelay:
      return "return-delay";
    case bus::Setting::kProfileUnit:
      return "profile-unit";
    case bus::Setting::kLock:
      return "lock";
    default:
      return "";
  }
}

Words SettingValue(bus::Setting setting, std::int32_t value) noexcept {
  if (setting == bus::Setting::kShutdown) {
    return FaultWords(static_cast<bus::HardwareFaults>(value));
  }
  Words words{};
  const char* name = nullptr;
  if (setting == bus::Setting::kProfileUnit) name = value != 0 ? "time" : "speed";
  if (setting == bus::Setting::kLock) name = value != 0 ? "closed" : "open";
  if (name != nullptr) {
    (void)std::snprintf(words.data(), words.size(), "%s", name);
  } else {
    (void)std::snprintf(words.data(), words.size(), "%d", value);
  }
  return words;
}

}  // namespace facewire::app
