#ifndef FACEWIRE_APP_GPIO_LINES_H_
#define FACEWIRE_APP_GPIO_LINES_H_

#include <array>
#include <memory>
#include <string>
#include <utility>

#include "app/config.h"
#include "hal/clock.h"
#include "hal/gpio.h"
#include "hal/gpiod/gpiod_line.h"

namespace facewire::app {

// The lines of a configuration; null: none.
struct GpioLines {
  std::unique_ptr<hal::GpioInput> stop;
  std::unique_ptr<hal::GpioInput> calibrate;
  std::unique_ptr<hal::GpioOutput> status_led;
  std::unique_ptr<hal::GpioOutput> servo_power;
};

// The keys of [gpio] with what the backend needs for each; an empty line name: none.
std::array<std::pair<const char*, hal::gpiod::GpiodConfig>, 4> GpioConfigs(const GpioConfig& gpio);

// The lines by their keys, for a person; "none".
std::string GpioSummary(const GpioConfig& gpio);

// Takes every line that the configuration names. `fake`: lines of hal/fake instead, with the
// contacts at rest. `clock` is borrowed. Throws BadInput with a line for each that cannot be had.
GpioLines OpenGpioLines(const GpioConfig& gpio, bool fake, hal::Clock& clock);

}  // namespace facewire::app

#endif  // FACEWIRE_APP_GPIO_LINES_H_
