#ifndef FACEWIRE_TOOLS_FACEWIRE_SERVO_WORDS_H_
#define FACEWIRE_TOOLS_FACEWIRE_SERVO_WORDS_H_

#include <string>
#include <string_view>

#include "app/animatronic/bus_config.h"
#include "core/bus/servo_bus.h"

// What buses and servos say about themselves, in words for a person.
namespace facewire::tools {

// "heat, overload"; "none".
std::string FaultsText(bus::HardwareFaults faults);
// As `facewire servo set` takes it; "" for what no command can set.
std::string_view SettingWord(bus::Setting setting);
// What a setting is, what it should be, and what mends it, for the servo of that name in that
// configuration.
std::string FindingText(const bus::Finding& finding, std::string_view servo,
                        const app::ServoBusConfig& bus, const std::string& config);
// Why a bus is at fault, and what to look at; "" when it is not.
std::string BusText(const bus::BusStatus& status, const app::ServoBusConfig& bus);

}  // namespace facewire::tools

#endif  // FACEWIRE_TOOLS_FACEWIRE_SERVO_WORDS_H_
