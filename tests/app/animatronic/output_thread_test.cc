#include "app/animatronic/output_thread.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <thread>

#include "hal/system_clock.h"
#include "tests/app/animatronic/sim_rig.h"

namespace facewire::app {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

TEST(OutputThread, ReportsNobodyBeforeItsFirstTick) {
  SimRig r;
  r.Build();
  EXPECT_EQ(r.thread->report().servo_count, 0);
  EXPECT_EQ(r.thread->report().bus_count, 0);
}

TEST(OutputThread, ReportsWhatItsServosDo) {
  SimRig r;
  r.Build();
  r.For(seconds(4), 1800);
  const ServoReport& report = r.thread->report();
  EXPECT_EQ(report.servo_count, 2);
  EXPECT_EQ(report.bus_count, 1);
  EXPECT_LE(r.clock.Now() - report.at, OutputThread::kReportEvery);
  EXPECT_EQ(report.servos[0].command.position, 1800);
  EXPECT_EQ(report.servos[0].command.activity, servo::Activity::kFollowing);
  EXPECT_EQ(report.servos[0].feedback.state, bus::ServoState::kOn);
  EXPECT_NEAR(report.servos[0].feedback.position.value_or(0), 1800, 12);
  EXPECT_TRUE(report.servos[0].feedback.temperature_c);
  EXPECT_EQ(report.buses[0].port, PortState::kUp);
  EXPECT_EQ(report.buses[0].state, bus::BusState::kRunning);
  EXPECT_FALSE(report.servos[0].stranded);
}

// The next bytes after a stop let go of everybody, and no servo is told to be elsewhere any more.
TEST(OutputThread, StopsWithinOneTick) {
  SimRig r;
  r.Build();
  r.For(seconds(3), 1500);
  r.For(milliseconds(60), 1900);  // on its way
  r.thread->SetStopped(true);
  r.Tick();
  r.clock.Advance(milliseconds(1));
  r.bus.Advance(r.clock.Now());
  EXPECT_FALSE(r.bus.TorqueOn(0));
  EXPECT_FALSE(r.bus.TorqueOn(1));
  const float stopped = r.output->animatronic().commands().servos[0].position;
  r.For(seconds(2), 1900);
  EXPECT_EQ(r.output->animatronic().commands().servos[0].position, stopped);
  EXPECT_FALSE(r.bus.TorqueOn(0));
  r.thread->SetStopped(false);
  r.For(seconds(5), 1900);
  EXPECT_NEAR(r.bus.Position(0), 1900, 12) << "after the release it goes on";
}

TEST(OutputThread, TakesSilenceAsTheRigsContractSays) {
  SimRig r;
  r.Build();
  r.For(seconds(4), 1900);
  r.For(r.rig.contract.fresh + r.rig.contract.hold + r.rig.contract.ease + milliseconds(300));
  EXPECT_NEAR(r.bus.Position(0), 1500, 12) << "neutral";
  EXPECT_TRUE(r.bus.TorqueOn(0));
  r.For(r.rig.contract.limp);
  EXPECT_FALSE(r.bus.TorqueOn(0));
}

TEST(OutputThread, SaysWhoIsStrandedAndSinceWhen) {
  SimRig r;
  r.Build();
  r.For(seconds(3), 1800);
  const Time cut = r.clock.Now();
  r.bus.Inject({.kind = sim::FaultKind::kMute, .servo = 1});
  r.For(seconds(2), 1800);
  const ServoReport& report = r.thread->report();
  EXPECT_FALSE(report.servos[0].stranded);
  ASSERT_TRUE(report.servos[1].stranded);
  EXPECT_GT(*report.servos[1].stranded, cut);
  EXPECT_LT(*report.servos[1].stranded - cut, milliseconds(1500));
}

TEST(OutputThread, SaysSinceWhenAPortIsLost) {
  SimRig r;
  r.Build();
  r.For(seconds(3), 1800);
  r.end.plugged = false;
  const Time lost = r.clock.Now();
  r.For(seconds(2), 1800);
  ASSERT_TRUE(r.thread->report().buses[0].closed);
  EXPECT_LE(*r.thread->report().buses[0].closed - lost, milliseconds(10));
  EXPECT_TRUE(r.thread->report().servos[0].stranded) << "nobody knows whether it has torque";
  r.end.plugged = true;
  r.For(seconds(3), 1800);
  EXPECT_FALSE(r.thread->report().buses[0].closed);
  EXPECT_FALSE(r.thread->report().servos[0].stranded);
}

TEST(OutputThread, AHandHasOneServoForAsLongAsItRepeatsItself) {
  SimRig r;
  r.Build();
  r.For(seconds(4), 1500);
  for (int i = 0; i < 40; ++i) {
    EXPECT_TRUE(r.thread->MoveByHand(0, 1900));
    r.For(milliseconds(50), 1500);
  }
  EXPECT_NEAR(r.bus.Position(0), 1900, 12);
  EXPECT_NEAR(r.bus.Position(1), 1500, 12) << "the performer's";
  EXPECT_EQ(r.thread->report().servos[0].command.activity, servo::Activity::kManual);
  EXPECT_EQ(r.thread->report().servos[1].command.activity, servo::Activity::kFollowing);
  r.For(milliseconds(300), 1500);  // fresh, 200 ms, is over
  EXPECT_EQ(r.thread->report().servos[0].command.activity, servo::Activity::kFollowing);
  r.For(seconds(2), 1500);
  EXPECT_NEAR(r.bus.Position(0), 1500, 12);
}

TEST(OutputThread, AHandHoldsNeitherLimitsNorAStopBack) {
  SimRig r;
  r.Build();
  r.For(seconds(4), 1500);
  for (int i = 0; i < 60; ++i) {
    EXPECT_TRUE(r.thread->MoveByHand(0, 9999));
    r.For(milliseconds(50), 1500);
  }
  EXPECT_NEAR(r.bus.Position(0), 2000, 12) << "its max";
  r.thread->SetStopped(true);
  for (int i = 0; i < 20; ++i) {
    EXPECT_TRUE(r.thread->MoveByHand(0, 1000));
    r.For(milliseconds(50), 1500);
  }
  EXPECT_FALSE(r.bus.TorqueOn(0));
  EXPECT_EQ(r.output->animatronic().commands().servos[0].position, 2000);
}

TEST(OutputThread, AHandIsRefusedWithoutAServoOrANumber) {
  SimRig r;
  r.Build();
  EXPECT_FALSE(r.thread->MoveByHand(2, 1500));
  EXPECT_FALSE(r.thread->MoveByHand(255, 1500));
  EXPECT_FALSE(r.thread->MoveByHand(0, SimRig::kNoWish));
}

// The real thread at its real pace, with wishes and stops from another.
TEST(OutputThread, KeepsItsPaceAndEndsLimp) {
  hal::SystemClock clock;
  SimRig r;
  SimEnd end{.bus = r.bus, .clock = clock};
  ServoOutput output({BusOf(BusKind::kFeetech, "chain")}, r.rig, clock,
                     [&](const ServoBusConfig&) { return std::make_unique<SimPort>(end); });
  output.Open();
  OutputThread thread(output, clock);
  thread.Begin();
  std::uint64_t ticks = 0;
  for (int i = 0; i < 60; ++i) {
    servo::Wishes wishes;
    wishes.captured = clock.Now();
    wishes.count = 2;
    wishes.positions[0] = wishes.positions[1] = 1600;
    thread.Hand(wishes);
    thread.SetStopped(i % 20 == 19);
    const ServoReport& report = thread.report();
    EXPECT_GE(report.ticks, ticks);
    ticks = report.ticks;
    clock.SleepUntil(clock.Now() + milliseconds(20));
  }
  thread.End();
  const ServoReport& last = thread.report();
  EXPECT_GT(last.ticks + last.late, 80U) << "of 120, on a busy machine";
  EXPECT_LE(last.ticks, 122U);
  EXPECT_FALSE(r.bus.TorqueOn(0));
  EXPECT_FALSE(r.bus.TorqueOn(1));
}

}  // namespace
}  // namespace facewire::app
