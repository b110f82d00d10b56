#include "core/servo/motion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include "tests/core/servo/generated_servos.h"
#include "tests/support/allocation_counter.h"

namespace facewire::servo {
namespace {

using std::chrono::hours;
using std::chrono::milliseconds;
using std::chrono::seconds;

// A pulse servo (0) and a bus servo (1), a tick every 10 ms, wishes every 30 ms.
class MotionTest : public testing::Test {
 protected:
  MotionTest() {
    (void)rig_.servos.try_push(PulseServo("jaw", 0));
    (void)rig_.servos.try_push(CountServo("neck", 1));
    rig_.following.calm = 0;
  }
  Result<> Configure() {
    const std::vector<Actuator> actuators = {kPulse, kCounts};
    return motion_->Configure(rig_, actuators);
  }
  void Wish(float jaw, float neck) {
    Wishes wishes{.captured = now_, .count = 2};
    wishes.positions = {jaw, neck};
    motion_->Take(wishes, now_);
  }
  const Commands& Tick() {
    now_ += milliseconds(10);
    motion_->SetReading(1, reading_, now_);
    out_ = motion_->Tick(now_);
    return out_;
  }
  // Ticks for so long, with that wish as often as a camera gives one.
  const Commands& Run(Duration time, float jaw, float neck) {
    for (const Time end = now_ + time; now_ < end;) {
      if ((ticks_++ % 3) == 0) Wish(jaw, neck);
      Tick();
    }
    return out_;
  }
  const Commands& RunSilent(Duration time) {
    for (const Time end = now_ + time; now_ < end;) Tick();
    return out_;
  }
  const Command& Jaw() const { return out_.servos[0]; }
  const Command& Neck() const { return out_.servos[1]; }
  void Follow() {
    ASSERT_TRUE(Configure());
    Run(seconds(20), 1500, 2048);
    ASSERT_EQ(Jaw().activity, Activity::kFollowing);
  }

  ServoRig rig_;
  std::unique_ptr<Motion> motion_ = std::make_unique<Motion>();
  Time now_{hours(5)};
  float reading_ = 2048;
  int ticks_ = 0;
  Commands out_;
};

TEST_F(MotionTest, RefusesWhatItCannotDo) {
  rig_.servos[1].max_speed_per_s = 0;
  EXPECT_EQ(Configure().error(), Errc::kOutOfRange);
  rig_.servos[1].max_speed_per_s = 100;
  rig_.servos[1].crawl_speed_per_s = 100;
  EXPECT_TRUE(Configure());
  EXPECT_EQ(motion_->Configure(rig_, std::vector<Actuator>{kPulse}).error(),
            Errc::kInvalidArgument);
  for (const float step : {0.F, -1.F, kNan, kInfinity}) {
    const std::vector<Actuator> wrong = {kPulse, {.step = step}};
    EXPECT_EQ(motion_->Configure(rig_, wrong).error(), Errc::kInvalidArgument);
  }
  const std::vector<Actuator> coarse = {kPulse, {.step = 1e5F}};
  EXPECT_EQ(motion_->Configure(rig_, coarse).error(), Errc::kOutOfRange);
}

TEST_F(MotionTest, WithoutAWishNothingHasTorque) {
  ASSERT_TRUE(Configure());
  RunSilent(seconds(10));
  EXPECT_EQ(out_.count, 2U);
  for (const Command& command : {Jaw(), Neck()}) {
    EXPECT_FALSE(command.torque);
    EXPECT_EQ(command.activity, Activity::kWaiting);
  }
}

TEST_F(MotionTest, TheFirstMotionBeginsAtThePositionThatWasReadBack) {
  ASSERT_TRUE(Configure());
  reading_ = 1300.4F;
  Wish(1500, 2048);
  Tick();
  EXPECT_TRUE(Neck().torque);
  EXPECT_EQ(Neck().position, 1300);
  EXPECT_TRUE(Neck().changed);
}

TEST_F(MotionTest, TheFirstMotionIsACrawlAndFasterAfterwards) {
  ASSERT_TRUE(Configure());
  reading_ = 1300;
  Wish(1500, 2048);
  Tick();
  float before = Neck().position;
  for (const Time end = now_ + milliseconds(4900); now_ < end;) {
    Run(milliseconds(10), 1500, 2048);
    EXPECT_LE(Neck().position - before, 150 * 0.01F);
    before = Neck().position;
  }
  EXPECT_GT(before, 1300 + 4.5 * 99) << "1 of the 1.5 counts a tick";
  Run(seconds(5), 1500, 2048);
  EXPECT_EQ(Neck().position, 2048);
  Run(milliseconds(400), 1500, 2900);
  EXPECT_GT(Neck().position, 2500);
}

TEST_F(MotionTest, FromAnyPoseAtPowerOnSpeedAndAccelerationStayWithinTheCrawl) {
  const Servo& neck = rig_.servos[1];
  const float part = neck.crawl_speed_per_s / neck.max_speed_per_s;
  const float most = neck.max_acceleration_per_s2 * part * 0.01F * 0.01F + 2;
  std::mt19937 random(3);
  std::uniform_real_distribution<float> anywhere(0, 4095);
  for (int round = 0; round < 30; ++round) {
    ASSERT_TRUE(Configure());
    reading_ = anywhere(random);
    const float start = std::clamp(std::round(reading_), neck.min, neck.max);
    const float wish = anywhere(random);
    const float end = std::clamp(wish, neck.min, neck.max);
    Run(milliseconds(30), 1500, wish);
    float before = start;
    float change = 0;
    while (std::abs(before - end) > 1) {
      Run(milliseconds(10), 1500, wish);
      const float now = Neck().position - before;
      ASSERT_LE(std::abs(now), neck.crawl_speed_per_s * 0.01F);
      ASSERT_LE(std::abs(now - change), most);
      ASSERT_LE(std::abs(Neck().position - end), std::abs(start - end) + 1) << "the right way";
      before = Neck().position;
      change = now;
    }
  }
}

TEST_F(MotionTest, WhatCannotBeReadStartsFromNeutral) {
  ASSERT_TRUE(Configure());
  Wish(1900, 2048);
  Tick();
  EXPECT_TRUE(Jaw().torque);
  EXPECT_EQ(Jaw().position, 1500);
  Run(milliseconds(500), 1900, 2048);
  EXPECT_GT(Jaw().position, 1500);
  EXPECT_LE(Jaw().position, 1500 + 0.5 * 200);
}

TEST_F(MotionTest, TorqueWaitsForAPositionThatHasNotBeenRead) {
  ASSERT_TRUE(Configure());
  reading_ = kNan;
  Run(seconds(1), 1500, 2048);
  EXPECT_TRUE(Jaw().torque);
  EXPECT_FALSE(Neck().torque);
  EXPECT_EQ(Neck().activity, Activity::kWaiting);
  reading_ = 2000;
  Run(milliseconds(10), 1500, 2048);
  EXPECT_TRUE(Neck().torque);
  EXPECT_EQ(Neck().position, 2000);
}

TEST_F(MotionTest, FollowsAWishAndIsSilentWhenItStandsStill) {
  Follow();
  Run(seconds(1), 1700, 2500);
  EXPECT_EQ(Jaw().position, 1700);
  EXPECT_EQ(Neck().position, 2500);
  for (int tick = 0; tick < 300; ++tick) {
    Run(milliseconds(10), 1700, 2500);
    EXPECT_FALSE(Jaw().changed);
    EXPECT_FALSE(Neck().changed);
  }
}

TEST_F(MotionTest, AWishBeyondTheLimitsMeansTheLimit) {
  Follow();
  Run(seconds(2), 5000, -kInfinity);
  EXPECT_EQ(Jaw().position, 2000);
  EXPECT_EQ(Neck().position, 1024);
}

TEST_F(MotionTest, SilenceHoldsThenEasesThenRestsThenGoesLimp) {
  Follow();
  Run(seconds(1), 1900, 2900);
  const Time last = now_ - milliseconds(10) * ((ticks_ + 2) % 3 + 1);
  const auto at = [&](Duration silent) {
    while (now_ < last + silent) Tick();
    return Jaw();
  };
  EXPECT_EQ(at(milliseconds(200)).activity, Activity::kFollowing);
  EXPECT_EQ(at(milliseconds(220)).activity, Activity::kHolding);
  EXPECT_EQ(at(milliseconds(600)).activity, Activity::kHolding);
  EXPECT_EQ(Jaw().position, 1900);
  EXPECT_EQ(at(milliseconds(620)).activity, Activity::kEasing);
  EXPECT_NEAR(at(milliseconds(600 + 750)).position, 1700, 15) << "half the way in half the time";
  EXPECT_EQ(at(milliseconds(2100)).activity, Activity::kEasing);
  EXPECT_EQ(at(milliseconds(2150)).activity, Activity::kResting);
  EXPECT_EQ(Jaw().position, 1500);
  EXPECT_TRUE(at(milliseconds(7100)).torque);
  EXPECT_FALSE(at(milliseconds(7110)).torque);
  EXPECT_EQ(Jaw().activity, Activity::kLimp);
  EXPECT_FALSE(Neck().torque);
}

TEST_F(MotionTest, TorqueGoesAfterTheContractsTimeEvenIfNeutralIsFarAway) {
  rig_.servos[0].max_speed_per_s = rig_.servos[0].crawl_speed_per_s = 10;
  Follow();
  Run(seconds(30), 1900, 2048);
  RunSilent(milliseconds(7200));
  EXPECT_NE(Jaw().position, 1500);
  EXPECT_FALSE(Jaw().torque);
}

TEST_F(MotionTest, AfterALossTheHeadStartsAgainFromWhereItWasLeft) {
  Follow();
  RunSilent(seconds(20));
  ASSERT_FALSE(Neck().torque);
  reading_ = 1500;  // somebody turned it
  RunSilent(seconds(5));
  ticks_ = 0;
  Run(milliseconds(10), 1500, 2048);
  EXPECT_TRUE(Neck().torque);
  EXPECT_EQ(Neck().position, 1500);
  Run(milliseconds(1000), 1500, 2048);
  EXPECT_LE(Neck().position, 1500 + 150) << "a crawl";
}

TEST_F(MotionTest, AServoWhoseWishesAreNoNumbersTakesTheContractsCourseAlone) {
  Follow();
  Run(seconds(1), kNan, 2500);
  EXPECT_EQ(Jaw().activity, Activity::kEasing);
  EXPECT_EQ(Neck().activity, Activity::kFollowing);
  Run(seconds(8), kNan, 2500);
  EXPECT_FALSE(Jaw().torque);
  EXPECT_EQ(Neck().position, 2500);
}

TEST_F(MotionTest, AFaceThatComesBackFadesIn) {
  Follow();
  Run(seconds(1), 1900, 2048);
  RunSilent(milliseconds(400));
  float before = Jaw().position;
  for (int tick = 0; tick < 60; ++tick) {
    Run(milliseconds(10), 1200, 2048);
    EXPECT_LE(before - Jaw().position, 700 * 1.5 / 30 + 1) << "a smooth step of 0.3 s, no leap";
    before = Jaw().position;
  }
  EXPECT_EQ(before, 1200);
}

TEST_F(MotionTest, AHandComesBeforeThePerformerForAsLongAsItInsists) {
  Follow();
  for (int tick = 0; tick < 100; ++tick) {
    motion_->SetManual(0, 1800, now_);
    Run(milliseconds(10), 1300, 2048);
  }
  EXPECT_EQ(Jaw().activity, Activity::kManual);
  EXPECT_EQ(Jaw().position, 1800);
  EXPECT_EQ(Neck().activity, Activity::kFollowing);
  Run(milliseconds(220), 1300, 2048);
  EXPECT_EQ(Jaw().activity, Activity::kFollowing) << "the tool has died";
  float before = Jaw().position;
  for (int tick = 0; tick < 60; ++tick) {
    Run(milliseconds(10), 1300, 2048);
    EXPECT_LE(before - Jaw().position, 500 * 1.5 / 30 + 1);
    before = Jaw().position;
  }
  EXPECT_EQ(before, 1300);
}

TEST_F(MotionTest, AHandMovesAServoThatNobodyElseMoves) {
  ASSERT_TRUE(Configure());
  for (int tick = 0; tick < 300; ++tick) {
    motion_->SetManual(0, 1600.1F, now_);
    Tick();
  }
  EXPECT_TRUE(Jaw().torque);
  EXPECT_EQ(Jaw().position, 1600) << "the step next to it";
  EXPECT_FALSE(Neck().torque);
  RunSilent(seconds(8));
  EXPECT_FALSE(Jaw().torque) << "the contract is the same";
}

TEST_F(MotionTest, WhatIsNotANumberOrNoServoChangesNothing) {
  Follow();
  for (const float wrong : {kNan}) {
    motion_->SetManual(0, wrong, now_);
    motion_->SetHealth(0, wrong);
    motion_->SetReading(0, wrong, now_);
  }
  motion_->SetManual(2, 1700, now_);
  motion_->SetHealth(64, 0);
  motion_->SetReading(1000, 1700, now_);
  Run(milliseconds(100), 1500, 2048);
  EXPECT_EQ(Jaw().activity, Activity::kFollowing);
  EXPECT_EQ(Jaw().position, 1500);
}

TEST_F(MotionTest, AStopFreezesEveryCommandAtOnceAndIsLatched) {
  rig_.contract.stop_torque = seconds(1);
  Follow();
  Run(milliseconds(120), 1900, 2900);
  const float jaw = Jaw().position;
  const float neck = Neck().position;
  ASSERT_GT(jaw, 1500);
  motion_->Stop();
  for (int tick = 0; tick < 500; ++tick) {
    motion_->SetManual(0, 1200, now_);
    Run(milliseconds(10), 1100, 1100);
    ASSERT_EQ(Jaw().position, jaw);
    ASSERT_EQ(Neck().position, neck);
    ASSERT_EQ(Jaw().activity, Activity::kStopped);
    ASSERT_EQ(Jaw().torque, tick < 99);
  }
}

TEST_F(MotionTest, AStopLetsGoInTheNextTickUnlessToldOtherwise) {
  Follow();
  motion_->Stop();
  Run(milliseconds(10), 1900, 2900);
  EXPECT_FALSE(Jaw().torque);
  EXPECT_FALSE(Neck().torque);
}

TEST_F(MotionTest, AfterAReleaseItCrawlsFromWhereTheServoIs) {
  for (const Duration torque : {Duration(0), Duration(seconds(100))}) {
    rig_.contract.stop_torque = torque;
    Follow();
    Run(seconds(2), 1900, 2900);
    motion_->Stop();
    reading_ = 2900;
    Run(seconds(1), 1900, 2900);
    motion_->Release();
    Run(milliseconds(10), 1200, 1200);
    EXPECT_TRUE(Neck().torque);
    float before = Neck().position;
    EXPECT_NEAR(before, 2900, 1);
    for (int tick = 0; tick < 300; ++tick) {
      Run(milliseconds(10), 1200, 1200);
      EXPECT_LE(before - Neck().position, 1.5);
      before = Neck().position;
    }
    EXPECT_LT(before, 2700);
    reading_ = 2048;
  }
}

TEST_F(MotionTest, AReleaseWithoutAStopChangesNothing) {
  Follow();
  motion_->Release();
  Run(milliseconds(300), 1900, 2900);
  EXPECT_GT(Jaw().position, 1700) << "no crawl";
}

TEST_F(MotionTest, AWarmServoIsSlowerAndAHotOneGoesLimpAlone) {
  Follow();
  motion_->SetHealth(1, 0.1F);
  Run(milliseconds(600), 1900, 2900);
  EXPECT_EQ(Jaw().position, 1900);
  EXPECT_LE(Neck().position, 2048 + 0.6 * 300);
  motion_->SetHealth(1, 0);
  Run(milliseconds(10), 1900, 2900);
  EXPECT_FALSE(Neck().torque);
  EXPECT_EQ(Neck().activity, Activity::kHot);
  EXPECT_TRUE(Jaw().torque);
  reading_ = 1800;
  motion_->SetHealth(1, 1);
  Run(milliseconds(10), 1900, 2900);
  EXPECT_TRUE(Neck().torque);
  EXPECT_EQ(Neck().position, 1800);
  Run(milliseconds(1000), 1900, 2900);
  EXPECT_LE(Neck().position, 1800 + 150);
}

TEST_F(MotionTest, WhatAControllerSaidBeforeItsLastCommandIsForgottenWithTheTorque) {
  Follow();
  motion_->SetReading(0, 1500, now_);
  Run(milliseconds(600), 1900, 2048);
  ASSERT_EQ(Jaw().position, 1900);
  motion_->SetHealth(0, 0);
  Run(milliseconds(10), 1900, 2048);
  ASSERT_FALSE(Jaw().torque);
  motion_->SetHealth(0, 1);
  Run(milliseconds(10), 1900, 2048);
  ASSERT_TRUE(Jaw().torque);
  EXPECT_EQ(Jaw().position, 1900);
}

TEST_F(MotionTest, AServoWithNothingToDoGoesLimpAndWakesWithoutACrawl) {
  rig_.servos[1].limp_after = seconds(2);
  Follow();
  Run(seconds(1), 1500, 2500);
  reading_ = 2503;  // gravity
  Run(seconds(3), 1500, 2500);
  EXPECT_FALSE(Neck().torque);
  EXPECT_EQ(Neck().activity, Activity::kIdle);
  EXPECT_TRUE(Jaw().torque);
  Run(seconds(30), 1500, 2504);
  EXPECT_FALSE(Neck().torque) << "within the dead band";
  Run(milliseconds(30), 1500, 1900);
  EXPECT_TRUE(Neck().torque);
  Run(milliseconds(500), 1500, 1900);
  EXPECT_EQ(Neck().position, 1900);
}

TEST_F(MotionTest, AnIdleServoThatWasTurnedByHandWakesAsACrawl) {
  rig_.servos[1].limp_after = seconds(2);
  Follow();
  reading_ = 1200;
  Run(seconds(3), 1500, 2048);
  ASSERT_EQ(Neck().activity, Activity::kIdle);
  Run(milliseconds(40), 1500, 2500);
  EXPECT_TRUE(Neck().torque);
  Run(milliseconds(1000), 1500, 2500);
  EXPECT_LE(Neck().position, 1200 + 160);
}

TEST_F(MotionTest, ALongSilenceOfTheTicksStopsTheMotionInsteadOfLeaping) {
  rig_.contract.hold = hours(2);
  Follow();
  Run(milliseconds(120), 1900, 2048);
  const float before = Jaw().position;
  now_ += hours(1);
  Wish(1900, 2048);
  Tick();
  EXPECT_EQ(Jaw().position, before);
}

TEST_F(MotionTest, TimeThatGoesBackALittleMovesNothing) {
  Follow();
  Run(milliseconds(120), 1900, 2048);
  const float before = Jaw().position;
  now_ -= milliseconds(60);
  Tick();
  EXPECT_EQ(Jaw().position, before);
}

TEST_F(MotionTest, AnotherClockDoesNotKeepTorqueOnForever) {
  Follow();
  now_ = Time(milliseconds(3));
  RunSilent(seconds(8));
  EXPECT_FALSE(Jaw().torque);
}

TEST_F(MotionTest, AllocatesNothing) {
  if (!test::AllocationCounter::kAvailable) GTEST_SKIP() << test::AllocationCounter::kWhyNot;
  Follow();
  test::AllocationCounter counter;
  counter.Arm();
  Run(seconds(2), 1700, 2500);
  motion_->Stop();
  Run(seconds(1), 1700, 2500);
  counter.Disarm();
  EXPECT_EQ(counter.allocations() + counter.frees(), 0U);
}

}  // namespace
}  // namespace facewire::servo
