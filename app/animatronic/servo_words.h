#ifndef FACEWIRE_APP_ANIMATRONIC_SERVO_WORDS_H_
#define FACEWIRE_APP_ANIMATRONIC_SERVO_WORDS_H_

#include <array>
#include <cstdint>

#include "core/bus/servo_bus.h"
#include "core/servo/aim.h"

// What servos report, in words that need no heap.
namespace facewire::app {

using Words = std::array<char, 96>;

const char* Name(servo::Activity activity) noexcept;
// "heat,overload"; "none".
Words FaultWords(bus::HardwareFaults faults) noexcept;
// As `facewire servo set` takes it; "" for what no command can set.
const char* SettingWord(bus::Setting setting) noexcept;
// The value of a setting, as that command takes it.
Words SettingValue(bus::Setting setting, std::int32_t value) noexcept;

}  // namespace facewire::app

#endif  // FACEWIRE_APP_ANIMATRONIC_SERVO_WORDS_H_
