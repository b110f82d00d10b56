// Real drivers and motion on a simulated chain, in virtual time.

#include "app/animatronic/servo_output.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/error.h"
#include "tests/app/animatronic/sim_rig.h"
#include "tests/app/scratch.h"

namespace facewire::app {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

TEST(ServoOutput, MovesItsServosToTheirWishes) {
  SimRig r;
  r.Build();
  r.For(seconds(4), 1800);
  EXPECT_TRUE(r.bus.TorqueOn(0));
  EXPECT_NEAR(r.bus.Position(0), 1800, 12);
  EXPECT_NEAR(r.bus.Position(1), 1800, 12);
  EXPECT_EQ(r.output->port(0), PortState::kUp);
  EXPECT_GT(r.output->counters(0).bytes_in, 0U);
}

TEST(ServoOutput, SaysEveryPortThatCannotBeOpened) {
  hal::fake::FakeClock clock;
  ServoOutput output({BusOf(BusKind::kMaestro, "nobody-a"), BusOf(BusKind::kFeetech, "nobody-b")},
                     RigOf({ServoOf("jaw", "nobody-a", 1), ServoOf("brow", "nobody-b", 1)}), clock);
  EXPECT_EQ(ProblemsOf([&] { output.Open(); }),
            "there is no port /dev/nobody-a; `facewire doctor` lists those there are\n"
            "there is no port /dev/nobody-b; `facewire doctor` lists those there are");
}

// A port that now and then takes a few bytes only: what arrives is whole packets, one after the
// other.
TEST(ServoOutput, FinishesWhatThePortTookInPartBeforeItSaysMore) {
  SimRig cut;
  cut.Build();
  for (int i = 0; i < 400; ++i) {
    cut.end.room = i % 5 == 0 ? static_cast<std::size_t>(i % 23) : SimEnd::kUnlimited;
    cut.For(milliseconds(10), 1800);
  }
  EXPECT_EQ(cut.bus.trace().Count(sim::EventKind::kDamagedPacket), 0U);
  EXPECT_NEAR(cut.bus.Position(0), 1800, 12);
}

TEST(ServoOutput, CountsAPortAsStuckThatTakesNothingForASecond) {
  SimRig r;
  r.Build();
  r.For(seconds(2), 1500);
  r.end.room = 0;
  r.For(milliseconds(900), 1600);
  EXPECT_EQ(r.output->port(0), PortState::kUp);
  r.For(milliseconds(400), 1600);
  EXPECT_EQ(r.output->port(0), PortState::kStuck);
  r.For(seconds(5), 1600);
  EXPECT_EQ(r.output->counters(0).stuck, 1U);
  r.end.room = SimEnd::kUnlimited;
  r.For(seconds(4), 1700);
  EXPECT_EQ(r.output->port(0), PortState::kUp);
  EXPECT_NEAR(r.bus.Position(0), 1700, 12);
}

TEST(ServoOutput, TakesALostPortAgainAndFindsItsServosAnew) {
  SimRig r;
  r.Build();
  r.For(seconds(3), 1800);
  r.end.plugged = false;
  r.For(seconds(2), 1800);
  EXPECT_EQ(r.output->port(0), PortState::kClosed);
  EXPECT_EQ(r.output->animatronic().feedback(0).state, bus::ServoState::kAbsent);
  EXPECT_EQ(r.output->counters(0).losses, 1U);
  r.end.plugged = true;
  r.end.incoming.clear();
  r.For(seconds(6), 1300);
  EXPECT_EQ(r.output->port(0), PortState::kUp);
  EXPECT_EQ(r.output->counters(0).reopens, 1U);
  EXPECT_EQ(r.output->animatronic().feedback(0).state, bus::ServoState::kOn);
  EXPECT_NEAR(r.bus.Position(0), 1300, 12);
}

TEST(ServoOutput, LeavesEverybodyLimpWhenItCloses) {
  SimRig r;
  r.Build();
  r.For(seconds(3), 1800);
  ASSERT_TRUE(r.bus.TorqueOn(0));
  const Time began = r.clock.Now();
  r.output->Close(milliseconds(500));
  EXPECT_LT(r.clock.Now() - began, milliseconds(300)) << "as soon as they say so";
  EXPECT_FALSE(r.bus.TorqueOn(0));
  EXPECT_FALSE(r.bus.TorqueOn(1));
  EXPECT_EQ(r.output->port(0), PortState::kClosed);
}

TEST(ServoOutput, GivesUpClosingWhereNothingIsTaken) {
  SimRig r;
  r.Build();
  r.For(seconds(3), 1800);
  r.end.room = 0;
  const Time began = r.clock.Now();
  r.output->Close(milliseconds(500));
  EXPECT_GE(r.clock.Now() - began, milliseconds(500));
  EXPECT_LE(r.clock.Now() - began, milliseconds(510));
}

}  // namespace
}  // namespace facewire::app
