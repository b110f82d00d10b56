#ifndef FACEWIRE_TOOLS_FACEWIRE_SERVO_SETTING_VALUE_H_
#define FACEWIRE_TOOLS_FACEWIRE_SERVO_SETTING_VALUE_H_

#include <cstdint>
#include <optional>
#include <string_view>

#include "core/bus/servo_bus.h"

namespace facewire::tools {

// The setting that app::SettingWord writes so; nullopt: none.
std::optional<bus::Setting> SettingOfWord(std::string_view word);
// A value as app::SettingArgument writes it: a number, "speed" or "time", "open" or "closed",
// "heat,overload". nullopt: not a value of that setting.
std::optional<std::int32_t> SettingValue(bus::Setting setting, std::string_view text);
// Digits alone.
std::optional<std::int32_t> WholeNumber(std::string_view text);

}  // namespace facewire::tools

#endif  // FACEWIRE_TOOLS_FACEWIRE_SERVO_SETTING_VALUE_H_
