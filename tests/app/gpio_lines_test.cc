#include "app/gpio_lines.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/error.h"
#include "hal/fake/fake_clock.h"

namespace facewire::app {
namespace {

using testing::HasSubstr;

GpioConfig AllLines() {
  GpioConfig gpio;
  gpio.chip = "a chip that no machine has";
  gpio.stop.line = "17";
  gpio.calibrate.line = "27";
  gpio.status_led.line = "22";
  gpio.servo_power.line = "23";
  return gpio;
}

TEST(GpioConfigs, TheStopIsAssertedWhileItsContactDoesNotConduct) {
  GpioConfig gpio = AllLines();
  EXPECT_FALSE(GpioConfigs(gpio)[0].second.active_low) << "to ground: high when it is cut";
  EXPECT_EQ(GpioConfigs(gpio)[0].second.bias, hal::gpiod::Bias::kPullUp);
  EXPECT_TRUE(GpioConfigs(gpio)[1].second.active_low) << "to ground: low when it is pressed";
  gpio.stop = {.line = "17", .active_low = false, .bias = hal::gpiod::Bias::kPullDown};
  EXPECT_TRUE(GpioConfigs(gpio)[0].second.active_low) << "to the supply: low when it is cut";
}

TEST(OpenGpioLines, NothingIsTakenWhenNothingIsNamed) {
  hal::fake::FakeClock clock;
  const GpioLines lines = OpenGpioLines({}, false, clock);
  EXPECT_FALSE(lines.stop || lines.calibrate || lines.status_led || lines.servo_power);
}

TEST(OpenGpioLines, NamesEveryLineThatCannotBeHad) {
  hal::fake::FakeClock clock;
  try {
    (void)OpenGpioLines(AllLines(), false, clock);
    FAIL() << "opened";
  } catch (const BadInput& error) {
    for (const char* key : {"gpio.stop_line: ", "\ngpio.calibrate_line: ",
                            "\ngpio.status_led_line: ", "\ngpio.servo_power_line: "}) {
      EXPECT_THAT(error.what(), HasSubstr(key));
    }
  }
}

TEST(OpenGpioLines, MockHardwareHasContactsAtRest) {
  hal::fake::FakeClock clock;
  const GpioLines lines = OpenGpioLines(AllLines(), true, clock);
  EXPECT_EQ(lines.stop->Get(), false) << "closed";
  EXPECT_EQ(lines.calibrate->Get(), false);
  EXPECT_TRUE(lines.status_led->Set(true));
  EXPECT_TRUE(lines.servo_power->Set(true));
}

TEST(GpioSummary, NamesTheLines) {
  EXPECT_EQ(GpioSummary({}), "none");
  GpioConfig gpio = AllLines();
  gpio.status_led.line = "";
  gpio.chip = "pinctrl-rp1";
  EXPECT_EQ(GpioSummary(gpio),
            "stop_line 17, calibrate_line 27, servo_power_line 23 on pinctrl-rp1");
}

}  // namespace
}  // namespace facewire::app
