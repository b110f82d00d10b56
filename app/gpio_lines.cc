#include "app/gpio_lines.h"

#include "app/error.h"
#include "hal/fake/fake_gpio.h"

namespace facewire::app {
namespace {

using hal::gpiod::GpiodConfig;

// Takes the line, if there is one; what keeps it from that joins the problems.
template <class Line>
void Open(const char* key, const GpiodConfig& config, std::unique_ptr<Line> made,
          std::unique_ptr<Line>& line, std::string& problems) {
  if (config.name.line.empty()) return;
  if (const Result<> opened = made->Open(); !opened) {
    const std::string reason(made->reason());
    problems += problems.empty() ? "" : "\n";
    problems += "gpio." + std::string(key) + ": " +
                (reason.empty() ? Name(opened.error()) : reason.c_str());
    return;
  }
  line = std::move(made);
}

}  // namespace

std::array<std::pair<const char*, GpiodConfig>, 4> GpioConfigs(const GpioConfig& gpio) {
  const auto config = [&](const GpioLineConfig& line) {
    return GpiodConfig{.name = {.chip = gpio.chip, .line = line.line},
                       .active_low = line.active_low,
                       .bias = line.bias};
  };
  GpiodConfig stop = config(gpio.stop);
  // The file says when the contact conducts, which is when all is well; the service's line is
  // asserted when it does not.
  stop.active_low = !gpio.stop.active_low;
  return {{{"stop_line", stop},
           {"calibrate_line", config(gpio.calibrate)},
           {"status_led_line", config(gpio.status_led)},
           {"servo_power_line", config(gpio.servo_power)}}};
}

std::string GpioSummary(const GpioConfig& gpio) {
  std::string text;
  for (const auto& [key, config] : GpioConfigs(gpio)) {
    if (config.name.line.empty()) continue;
    text += (text.empty() ? "" : ", ") + std::string(key) + " " + config.name.line;
  }
  if (text.empty()) return "none";
  return text + (gpio.chip.empty() ? "" : " on " + gpio.chip);
}

GpioLines OpenGpioLines(const GpioConfig& gpio, bool fake, hal::Clock& clock) {
  const auto input = [&](const GpiodConfig& config) -> std::unique_ptr<hal::GpioInput> {
    if (fake) return std::make_unique<hal::fake::FakeGpioInput>();
    return std::make_unique<hal::gpiod::GpiodInput>(config);
  };
  const auto output = [&](const GpiodConfig& config) -> std::unique_ptr<hal::GpioOutput> {
    if (fake) return std::make_unique<hal::fake::FakeGpioOutput>(clock);
    return std::make_unique<hal::gpiod::GpiodOutput>(config);
  };
  const auto [stop, calibrate, status_led, servo_power] = GpioConfigs(gpio);
  GpioLines lines;
  std::string problems;
  Open(stop.first, stop.second, input(stop.second), lines.stop, problems);
  Open(calibrate.first, calibrate.second, input(calibrate.second), lines.calibrate, problems);
  Open(status_led.first, status_led.second, output(status_led.second), lines.status_led, problems);
  Open(servo_power.first, servo_power.second, output(servo_power.second), lines.servo_power,
       problems);
  if (!problems.empty()) throw BadInput(problems);
  return lines;
}

}  // namespace facewire::app
