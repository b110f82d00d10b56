#include "app/animatronic/servo_watch.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/app/animatronic/servos.h"

namespace facewire::app {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

class Watch : public testing::Test {
 protected:
  Watch() {
    report.bus_count = 1;
    report.servo_count = 2;
    report.buses[0].port = PortState::kUp;
    for (auto& servo : report.servos) servo.feedback.state = bus::ServoState::kOn;
  }
  // What the journal hears in that time.
  std::string In(Duration time, bool powered = true) {
    testing::internal::CaptureStderr();
    for (const Time end = now + time; now < end; now += milliseconds(50)) {
      watch.Look(report, powered, now);
    }
    return testing::internal::GetCapturedStderr();
  }
  bus::ServoFeedback& jaw() { return report.servos[0].feedback; }

  Journal journal{"/no/journal"};
  servo::ServoRig rig = RigOf({ServoOf("jaw", "chain", 1), ServoOf("brow", "chain", 2)});
  ServoWatch watch{journal, rig, {app::BusOf(BusKind::kFeetech, "chain")}};
  ServoReport report;
  Time now{seconds(100)};
};

TEST_F(Watch, SaysNothingWhileAllIsWell) { EXPECT_EQ(In(seconds(10)), ""); }

TEST_F(Watch, NamesTheServoThatIsHotAndItsDegrees) {
  jaw().reason = bus::Reason::kHeat;
  jaw().factor = 0.7F;
  jaw().temperature_c = 58;
  EXPECT_EQ(In(seconds(10)),
            "facewired: servo jaw (bus chain, id 1): is hot, 58 degrees Celsius, and slowed down; "
            "at 65 it is let go\n");
  jaw().factor = 0;
  jaw().temperature_c = 66;
  EXPECT_EQ(In(seconds(10)),
            "facewired: servo jaw (bus chain, id 1): is too hot, 66 degrees Celsius: let go until "
            "it has 50\n");
  jaw() = {};
  jaw().state = bus::ServoState::kOn;
  EXPECT_EQ(In(seconds(10)), "facewired: servo jaw (bus chain, id 1): is well again\n");
}

TEST_F(Watch, SaysWhoDoesNotAnswerWhenItLasts) {
  jaw().state = bus::ServoState::kAbsent;
  EXPECT_EQ(In(milliseconds(1900)), "");
  EXPECT_EQ(In(seconds(5)), "facewired: servo jaw (bus chain, id 1): does not answer\n");
}

TEST_F(Watch, HasNoNewsOfServosWithoutPower) {
  jaw().state = bus::ServoState::kAbsent;
  report.buses[0].fault = bus::BusFault::kNobodyAnswers;
  EXPECT_EQ(In(seconds(10), false), "");
}

TEST_F(Watch, TellsOfALostBusAndNotOfAllItsServos) {
  report.buses[0].port = PortState::kClosed;
  jaw().state = bus::ServoState::kAbsent;
  report.servos[1].feedback.state = bus::ServoState::kAbsent;
  EXPECT_EQ(In(seconds(10)),
            "facewired: bus chain (serial:/dev/chain, 1000000 baud): its port is gone; it is tried "
            "again\n");
  report.buses[0].port = PortState::kUp;
  for (auto& servo : report.servos) servo.feedback.state = bus::ServoState::kOn;
  EXPECT_EQ(In(seconds(10)),
            "facewired: bus chain (serial:/dev/chain, 1000000 baud): is well again\n");
}

TEST_F(Watch, SaysWhatMendsASetting) {
  jaw().state = bus::ServoState::kRefused;
  jaw().reason = bus::Reason::kSettings;
  ASSERT_TRUE(report.findings.try_push({.servo = 0,
                                        .setting = bus::Setting::kOperatingMode,
                                        .found = 1,
                                        .wanted = 3,
                                        .refused = true}));
  EXPECT_EQ(
      In(seconds(10)),
      "facewired: servo jaw (bus chain, id 1): its operating mode is 1 and should be 3; it is "
      "left limp until then: facewire servo set jaw mode 3\n");
}

// The command is one that a shell can take.
TEST_F(Watch, SaysWhatMendsAServoThatWouldNotSwitchItselfOff) {
  jaw().state = bus::ServoState::kRefused;
  ASSERT_TRUE(report.findings.try_push(
      {.servo = 0,
       .setting = bus::Setting::kShutdown,
       .found = 0,
       .wanted = bus::Bit(bus::HardwareFault::kHeat) | bus::Bit(bus::HardwareFault::kShock),
       .refused = true}));
  EXPECT_EQ(In(seconds(10)),
            "facewired: servo jaw (bus chain, id 1): its shutdown conditions is none and should be "
            "heat, electrical shock; it is left limp until then: facewire servo set jaw shutdown "
            "heat,electricalshock\n");
}

TEST_F(Watch, NamesHardwareFaults) {
  jaw().reason = bus::Reason::kHardware;
  jaw().factor = 0;
  jaw().faults = bus::Bit(bus::HardwareFault::kOverload) | bus::Bit(bus::HardwareFault::kHeat);
  EXPECT_EQ(In(seconds(10)),
            "facewired: servo jaw (bus chain, id 1): reports heat, overload and is let go\n");
}

}  // namespace
}  // namespace facewire::app
