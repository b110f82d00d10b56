#ifndef FACEWIRE_TOOLS_FACEWIRE_SERVO_WORDS_H_
#define FACEWIRE_TOOLS_FACEWIRE_SERVO_WORDS_H_

#include <string>
#include <string_view>

#include "app/animatronic/bus_config.h"
#include "core/bus/servo_bus.h"

// What is wrong with buses and servos and what mends it, as an operator reads it; the single words
// are those of app/animatronic/servo_words.h.
namespace facewire::tools {

// What a setting is, what it should be, and what mends it, for the servo of that name in that
// configuration.
std::string FindingText(const bus::Finding& finding, std::string_view servo,
                        const app::ServoBusConfig& bus, const std::string& config);
// Why a bus is at fault, and what to look at; "" when it is not.
std::string BusText(const bus::BusStatus& status, const app::ServoBusConfig& bus);

}  // namespace facewire::tools

#endif  // FACEWIRE_TOOLS_FACEWIRE_SERVO_WORDS_H_
