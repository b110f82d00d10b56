#ifndef FACEWIRE_APP_ANIMATRONIC_SERVO_WORDS_H_
#define FACEWIRE_APP_ANIMATRONIC_SERVO_WORDS_H_

#include <array>
#include <cstdint>

#include "core/bus/servo_bus.h"
#include "core/servo/aim.h"

// What servos and their settings are called: in the journal and the status, and in the tools. No
// heap: the service speaks while it runs.
namespace facewire::app {

// Ended by a zero. All that is listed below fits.
using Words = std::array<char, 160>;

const char* Name(servo::Activity activity) noexcept;
// "heat, electrical shock"; "none".
Words FaultWords(bus::HardwareFaults faults, const char* between = ", ") noexcept;
// Of a Maestro: "serial CRC, serial timeout"; "none".
Words SerialErrorWords(std::uint16_t errors) noexcept;
// As `facewire servo set` takes it; "" for what no command can set.
const char* SettingWord(bus::Setting setting) noexcept;
// The value of a setting for a person: "250 us", "closed", "heat, electrical shock".
Words SettingWords(bus::Setting setting, std::int32_t value) noexcept;
// The same as one word, as `facewire servo set` takes it: "250", "closed", "heat,electricalshock".
Words SettingArgument(bus::Setting setting, std::int32_t value) noexcept;

}  // namespace facewire::app

#endif  // FACEWIRE_APP_ANIMATRONIC_SERVO_WORDS_H_
