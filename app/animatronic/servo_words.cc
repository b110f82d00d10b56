#include "app/animatronic/servo_words.h"

#include <algorithm>
#include <cstdio>

#include "core/wire/maestro/maestro.h"

namespace facewire::app {
namespace {

using bus::Setting;

// The names of the bits that are set.
template <typename Bit>
Words Named(unsigned bits, const char* between) noexcept {
  Words words{};
  std::size_t size = 0;
  for (unsigned bit = 0; bits >> bit != 0; ++bit) {
    if ((bits >> bit & 1U) == 0) continue;
    const int added = std::snprintf(words.data() + size, words.size() - size, "%s%s",
                                    size == 0 ? "" : between, Name(static_cast<Bit>(1U << bit)));
    size = std::min(size + static_cast<std::size_t>(added), words.size() - 1);
  }
  return size == 0 ? Words{"none"} : words;
}

Words Printed(const char* format, std::int32_t value) noexcept {
  Words words{};
  (void)std::snprintf(words.data(), words.size(), format, value);
  return words;
}

}  // namespace

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

Words FaultWords(bus::HardwareFaults faults, const char* between) noexcept {
  return Named<bus::HardwareFault>(faults, between);
}

Words SerialErrorWords(std::uint16_t errors) noexcept {
  return Named<wire::maestro::Error>(errors, ", ");
}

const char* SettingWord(Setting setting) noexcept {
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

Words SettingWords(Setting setting, std::int32_t value) noexcept {
  switch (setting) {
    case Setting::kShutdown:
      return FaultWords(static_cast<bus::HardwareFaults>(value));
    case Setting::kReturnDelay:
      return Printed("%d us", value);
    case Setting::kProfileUnit:
      return value != 0 ? Words{"time"} : Words{"speed"};
    case Setting::kLock:
      return value != 0 ? Words{"closed"} : Words{"open"};
    case Setting::kPulseRange:
      return Printed("%d us", value / 4);
    case Setting::kSerialErrors:
      return SerialErrorWords(static_cast<std::uint16_t>(value));
    default:
      return Printed("%d", value);
  }
}

Words SettingArgument(Setting setting, std::int32_t value) noexcept {
  if (setting == Setting::kReturnDelay) return Printed("%d", value);
  const Words words = SettingWords(setting, value);
  Words argument{};
  (void)std::ranges::remove_copy(words, argument.begin(), ' ');
  return argument;
}

}  // namespace facewire::app
