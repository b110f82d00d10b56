#include "tools/facewire/doctor_gpio.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/hal/gpiod/fake_chips.h"

namespace facewire::tools {
namespace {

using hal::gpiod::FakeChips;
using testing::HasSubstr;

// A Raspberry Pi 5 whose configuration names all lines.
struct Board {
  Board() {
    chips.AddChip("gpiochip0", "pinctrl-rp1", std::vector<std::string>(54));
    gpio.chip = "pinctrl-rp1";
    gpio.stop.line = "17";
    gpio.servo_power.line = "23";
  }
  std::vector<Finding> Check() { return CheckGpio(&gpio, chips); }
  FakeChips chips;
  app::GpioConfig gpio;
};

TEST(DoctorGpio, ListsChipsAndTheLinesOfTheConfiguration) {
  Board b;
  const std::vector<Finding> findings = b.Check();
  ASSERT_EQ(findings.size(), 3U);
  EXPECT_EQ(findings[0].found, "/dev/gpiochip0: \"pinctrl-rp1\", 54 lines, 0 in use");
  EXPECT_EQ(findings[1].what, "stop_line");
  EXPECT_EQ(findings[1].found, "line 17 of gpiochip0 (pinctrl-rp1)");
  EXPECT_EQ(findings[2].what, "servo_power_line");
  for (const Finding& finding : findings) EXPECT_EQ(finding.verdict, Verdict::kOk);
}

TEST(DoctorGpio, ALineIsFreeOrTheServicesOrInTheWay) {
  Board b;
  b.chips.chips[0].lines[17] = {"", true, "facewire"};
  b.chips.chips[0].lines[23] = {"", true, "led0"};
  const std::vector<Finding> findings = b.Check();
  EXPECT_EQ(findings[1].verdict, Verdict::kOk);
  EXPECT_THAT(findings[1].found, HasSubstr("held by facewired"));
  EXPECT_EQ(findings[2].verdict, Verdict::kFail);
  EXPECT_THAT(findings[2].found, HasSubstr("is in use by \"led0\""));
  EXPECT_NE(findings[2].fix, "");
}

TEST(DoctorGpio, SaysWhatIsThereWhenTheConfigurationIsOfAnotherBoard) {
  Board b;
  b.gpio.chip = "pinctrl-bcm2711";
  const std::vector<Finding> findings = b.Check();
  EXPECT_EQ(findings[1].verdict, Verdict::kFail);
  EXPECT_THAT(findings[1].found, HasSubstr("this machine has: gpiochip0 (pinctrl-rp1)"));
}

TEST(DoctorGpio, AForbiddenChipComesWithWhatGivesTheRight) {
  Board b;
  b.chips.describe_errors["/dev/gpiochip0"] = EACCES;
  const std::vector<Finding> findings = b.Check();
  EXPECT_EQ(findings[0].verdict, Verdict::kWarn) << "a board without switches needs no right";
  EXPECT_THAT(findings[0].fix, HasSubstr("sudo"));
  EXPECT_EQ(findings[1].verdict, Verdict::kFail);
  EXPECT_EQ(findings[1].fix, "see the GPIO chip above");
}

TEST(DoctorGpio, AMachineWithoutChipsIsFineUntilItNeedsOne) {
  FakeChips none;
  ASSERT_EQ(CheckGpio(nullptr, none).size(), 1U);
  EXPECT_EQ(CheckGpio(nullptr, none)[0].verdict, Verdict::kOk);
  Board b;
  b.chips.chips.clear();
  EXPECT_EQ(b.Check()[1].verdict, Verdict::kFail);
}

}  // namespace
}  // namespace facewire::tools
