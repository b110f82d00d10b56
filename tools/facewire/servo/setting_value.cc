#include "tools/facewire/servo/setting_value.h"

#include <charconv>
#include <string>

#include "app/animatronic/servo_words.h"

namespace facewire::tools {
namespace {

using bus::Setting;

std::string WithoutSpaces(std::string_view text) {
  std::string kept;
  for (const char c : text) {
    if (c != ' ') kept += c;
  }
  return kept;
}

std::optional<std::int32_t> Faults(std::string_view text) {
  unsigned faults = 0;
  const std::string all = WithoutSpaces(text) + ",";
  if (all == "none,") return 0;
  for (std::size_t at = 0; at < all.size();) {
    const std::size_t end = all.find(',', at);
    const std::string word = all.substr(at, end - at);
    unsigned bit = 0;
    while (bit < 6 && WithoutSpaces(Name(static_cast<bus::HardwareFault>(1U << bit))) != word)
      ++bit;
    if (bit == 6) return std::nullopt;
    faults |= 1U << bit;
    at = end + 1;
  }
  return static_cast<std::int32_t>(faults);
}

}  // namespace

std::optional<Setting> SettingOfWord(std::string_view word) {
  for (const Setting setting :
       {Setting::kOperatingMode, Setting::kMinPosition, Setting::kMaxPosition, Setting::kShutdown,
        Setting::kReturnDelay, Setting::kProfileUnit, Setting::kLock}) {
    if (app::SettingWord(setting) == word) return setting;
  }
  return std::nullopt;
}

std::optional<std::int32_t> WholeNumber(std::string_view text) {
  std::int32_t value = 0;
  const char* const end = text.data() + text.size();
  if (std::from_chars(text.data(), end, value) != std::from_chars_result{end, {}}) {
    return std::nullopt;
  }
  return value;
}

std::optional<std::int32_t> SettingValue(Setting setting, std::string_view text) {
  const auto one_of = [&](std::string_view zero,
                          std::string_view one) -> std::optional<std::int32_t> {
    if (text == zero) return 0;
    return text == one ? std::optional(1) : std::nullopt;
  };
  if (setting == Setting::kShutdown) return Faults(text);
  if (setting == Setting::kProfileUnit) return one_of("speed", "time");
  if (setting == Setting::kLock) return one_of("open", "closed");
  return WholeNumber(text);
}

}  // namespace facewire::tools
