#include "app/panel.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "hal/fake/fake_clock.h"
#include "hal/fake/fake_gpio.h"

namespace facewire::app {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::ElementsAre;
using testing::IsEmpty;
using S = ServiceState;

// A panel with all its lines, looked at 50 times a second.
struct Board {
  // A tick in which all is well, but for what the test changes in `view`.
  void Tick() {
    clock.Advance(milliseconds(20));
    open = panel.ReadStop(clock.Now());
    const Button::Press press = panel.ReadButton(clock.Now());
    if (press != Button::Press::kNone) presses.push_back(press);
    view.now = clock.Now();
    panel.Show(view);
  }
  void For(Duration time) {
    for (const Time end = clock.Now() + time; clock.Now() < end;) Tick();
  }

  hal::fake::FakeClock clock{Time{seconds(1000)}};
  hal::fake::FakeGpioInput stop;
  hal::fake::FakeGpioInput button;
  hal::fake::FakeGpioOutput led{clock};
  hal::fake::FakeGpioOutput power{clock};
  std::vector<std::string> said;
  Panel panel{{.stop = &stop, .calibrate = &button, .status_led = &led, .servo_power = &power},
              [this](const char* text) { said.emplace_back(text); }};
  PanelView view{.state = S::kTracking, .torque = true, .pose_taken = true};
  bool open = false;
  std::vector<Button::Press> presses;
};

TEST(PanelStop, IsOpenAtOnceWhenTheContactOpensAndAsLongAsItIs) {
  Board b;
  b.Tick();
  EXPECT_FALSE(b.open);
  b.stop.Hold(true);
  b.Tick();
  EXPECT_TRUE(b.open);
  EXPECT_TRUE(b.panel.stop_open());
  b.stop.Hold(false);
  b.Tick();
  EXPECT_FALSE(b.open) << "to latch it is the state machine's";
  EXPECT_FALSE(b.panel.stop_open());
}

TEST(PanelStop, CountsAsOpenWhenItCannotBeReadAndSaysSo) {
  for (const Errc fault : {Errc::kIo, Errc::kDisconnected}) {
    Board b;
    b.Tick();
    b.said.clear();
    b.stop.Break(fault);
    b.For(seconds(3));
    EXPECT_TRUE(b.open);
    EXPECT_THAT(b.said, ElementsAre("emergency stop: cannot be read, which counts as open"));
    b.said.clear();
    b.stop.Repair();
    b.For(seconds(9));
    EXPECT_FALSE(b.open);
    EXPECT_THAT(b.said, ElementsAre("emergency stop: closed; a release ends the stop"));
  }
}

TEST(PanelStop, TellsOfABouncingContactOnceASecondAndThenHowItIs) {
  Board b;
  b.Tick();
  b.said.clear();
  for (int i = 0; i < 200; ++i) {  // four seconds
    b.stop.Hold(i % 2 == 0);
    b.Tick();
  }
  EXPECT_LE(b.said.size(), 5U);
  b.stop.Hold(true);
  b.For(seconds(2));
  EXPECT_EQ(b.said.back(), "emergency stop: open");
}

TEST(PanelButton, TellsShortAndLongPresses) {
  Board b;
  b.For(milliseconds(100));
  b.button.Hold(true);
  b.For(milliseconds(300));
  b.button.Hold(false);
  b.For(milliseconds(300));
  b.button.Hold(true);
  b.For(milliseconds(2300));
  EXPECT_THAT(b.presses, ElementsAre(Button::Press::kShort, Button::Press::kLong));
}

TEST(PanelButton, IsNotPressedWhenItCannotBeRead) {
  Board b;
  b.For(milliseconds(100));
  b.said.clear();
  b.button.Hold(true);
  b.For(milliseconds(1000));
  b.button.Break(Errc::kIo);
  b.For(seconds(2));
  b.button.Repair();
  b.For(seconds(3));
  EXPECT_THAT(b.presses, IsEmpty()) << "nor is a press whose middle is missing";
  EXPECT_THAT(b.said, ElementsAre("button: cannot be read", "button: can be read"));
}

TEST(PanelPower, IsOffUntilTheLineHasTakenAPose) {
  Board b;
  b.view.state = S::kStarting;
  b.view.pose_taken = false;
  b.For(seconds(2));
  EXPECT_EQ(b.power.changes().total(), 0U);
  b.view.pose_taken = true;
  b.Tick();
  EXPECT_TRUE(b.power.asserted());
  EXPECT_THAT(b.said, ElementsAre("servo power: on"));
}

TEST(PanelPower, GoesWithTheTorqueOfTheStateMachine) {
  Board b;
  b.Tick();
  ASSERT_TRUE(b.power.asserted());
  for (const S state : {S::kStopped, S::kResting}) {
    b.view.state = state;
    b.view.torque = false;
    b.Tick();
    EXPECT_FALSE(b.power.asserted()) << Name(state);
    b.view.state = S::kStarting;
    b.view.torque = true;
    b.Tick();
    EXPECT_TRUE(b.power.asserted());
  }
}

TEST(PanelPower, IsOffInAFaultUntilAPoseWasTakenAfterIt) {
  Board b;
  b.Tick();
  b.view.state = S::kFault;
  b.Tick();
  EXPECT_FALSE(b.power.asserted()) << "though there is torque yet, and the line takes poses";
  b.view.state = S::kStarting;
  b.view.pose_taken = false;
  b.Tick();
  EXPECT_FALSE(b.power.asserted()) << "the pose before the fault does not count";
  b.view.pose_taken = true;
  b.Tick();
  EXPECT_TRUE(b.power.asserted());
}

TEST(PanelPower, GoesAndComesWithTheWordOfTheServosOnBuses) {
  Board b;
  b.view.servos_well = false;
  b.Tick();
  EXPECT_FALSE(b.power.asserted());
  b.view.servos_well = true;
  b.Tick();
  EXPECT_TRUE(b.power.asserted());
  b.view.servos_well = false;
  b.Tick();
  EXPECT_FALSE(b.power.asserted());
}

TEST(PanelPower, GoesWhenTheLineTakesNoPoseForASecond) {
  Board b;
  b.Tick();
  b.view.pose_taken = false;
  b.For(milliseconds(960));
  EXPECT_TRUE(b.power.asserted()) << "a pose may be dropped now and then";
  b.For(milliseconds(60));
  EXPECT_FALSE(b.power.asserted());
  b.view.pose_taken = true;
  b.Tick();
  EXPECT_TRUE(b.power.asserted());
}

TEST(PanelPower, IsOffInTheLastTickAndWhenNothingCanHelp) {
  Board b;
  b.Tick();
  b.view.ending = true;
  b.Tick();
  EXPECT_FALSE(b.power.asserted());
  EXPECT_FALSE(b.led.asserted());
}

// Every mixture of what a tick may come to, in random order: there is no way to power but by all
// the conditions at once.
TEST(PanelPower, IsNeverOnWithoutEveryCondition) {
  Board b;
  std::uint32_t dice = 12345;
  const auto roll = [&](std::uint32_t sides) {
    dice = dice * 1664525U + 1013904223U;
    return (dice >> 16U) % sides;
  };
  Time taken{};
  int on = 0;
  for (int i = 0; i < 20'000; ++i) {
    b.view = {.state = static_cast<S>(roll(8)),
              .torque = roll(8) != 0,
              .pose_taken = roll(60) == 0,
              .calibrating = roll(2) == 0,
              .ending = roll(50) == 0};
    b.Tick();
    if (b.view.pose_taken) taken = b.clock.Now();
    if (!b.power.asserted()) continue;
    ++on;
    EXPECT_TRUE(b.view.torque && !b.view.ending && b.view.state != S::kFault &&
                b.clock.Now() - taken < Panel::kUnheard)
        << i;
  }
  EXPECT_GT(on, 100);
}

TEST(PanelLight, BeginsThePatternAnewWithTheState) {
  Board b;
  b.view.state = S::kResting;
  b.For(milliseconds(1500));
  EXPECT_FALSE(b.led.asserted());
  b.view.state = S::kStopped;
  b.Tick();
  EXPECT_TRUE(b.led.asserted());
  b.view.state = S::kTracking;
  b.For(seconds(1));
  const std::uint64_t before = b.led.changes().total();
  b.For(seconds(2));
  EXPECT_EQ(b.led.changes().total(), before) << "steady";
  b.view.calibrating = true;
  b.For(seconds(3));
  EXPECT_GT(b.led.changes().total(), before + 8);
}

TEST(Panel, TakesALineThatWasLostAgainWithBackOff) {
  Board b;
  b.Tick();
  b.power.Break(Errc::kDisconnected);
  b.stop.Break(Errc::kDisconnected);
  b.For(seconds(20));
  EXPECT_GE(b.stop.opens(), 4);
  EXPECT_LE(b.stop.opens(), 8);
  EXPECT_LE(b.power.opens(), 8);
  b.stop.Repair();
  b.power.Repair();
  b.For(seconds(9));
  EXPECT_FALSE(b.open);
  EXPECT_TRUE(b.power.asserted());
}

TEST(Panel, WorksWithoutAnyLine) {
  Panel panel({}, {});
  EXPECT_FALSE(panel.ReadStop(Time{}));
  EXPECT_EQ(panel.ReadButton(Time{}), Button::Press::kNone);
  panel.Show({});
}

}  // namespace
}  // namespace facewire::app
