#include "tests/animatronic/judge.h"

#include <gtest/gtest.h>

#include <chrono>
#include <vector>

#include "tests/animatronic/line.h"

// The judge bites: each rule is broken once here.

namespace facewire::stage {
namespace {

using std::chrono::milliseconds;

constexpr Duration kTick = milliseconds(10);

// Two Dynamixels, of which the second stays below the first. 3072 counts a second are 30 a tick.
class JudgeTest : public testing::Test {
 protected:
  JudgeTest() {
    for (std::uint8_t id = 0; id < 2; ++id) {
      (void)rig.servos.try_push(ServoOf(Kind::kDynamixel, id, id));
    }
    (void)rig.linkages.try_push({.name = *ShortName::From("below"),
                                 .yields = 1,
                                 .other = 0,
                                 .relation = servo::Relation::kAtMost});
    Start();
  }
  void Start() {
    const Wire wire{.step = 1, .reaction = milliseconds(12), .lets_go = {}, .own_speed = 4000};
    judge = std::make_unique<Judge>(rig, std::vector<Wire>(2, wire));
    commands.count = 2;
    for (std::size_t i = 0; i < 2; ++i) {
      commands.servos[i] = {.position = 2048, .torque = true};
      seen[i] = {.torque = true, .goal = 2048, .commanded = 2048, .position = 2048, .sensed = 2048};
    }
    for (int i = 0; i < 20; ++i) Tick();  // long enough for a servo to brake
  }
  void Tell(std::size_t servo, float position) {
    commands.servos[servo].position = position;
    for (std::size_t i = 0; i < 2; ++i) judge->Wished(i, now);
    judge->Told(now, kTick, commands);
  }
  void Look(Duration time) {
    for (const Time end = now + time; now < end;) {
      now += milliseconds(1);
      judge->Look(now, seen);
    }
  }
  void Tick() {
    Tell(0, commands.servos[0].position);
    Look(kTick);
  }
  // Servo 0 is told, and its bus takes it; the servo goes there at its own speed.
  void Move(float position) {
    Tell(0, position);
    seen[0].goal = seen[0].commanded = seen[0].sensed = position;
    Look(kTick);
  }
  void ExpectOnly(Rule rule) {
    EXPECT_GE(judge->Count(rule), 1U) << Name(rule);
    EXPECT_EQ(judge->Count(), judge->Count(rule)) << judge->Report();
  }

  servo::ServoRig rig;
  std::unique_ptr<Judge> judge;
  servo::Commands commands;
  std::array<Seen, 2> seen;
  Time now{std::chrono::seconds(1)};
};

TEST_F(JudgeTest, HasNothingToSayOfServosThatDoAsTheyShould) {
  float at = 2048;
  for (const float step : {1.F, 3.F, 4.F, 3.F, 1.F, 0.F, 0.F}) Move(at += step);
  EXPECT_EQ(judge->Report(), "");
  EXPECT_GT(judge->looks(), 100U);
}

TEST_F(JudgeTest, SeesACommandBeyondTheLimits) {
  rig.servos[0].max = 2050;
  Start();
  Move(2051);
  ExpectOnly(Rule::kLimits);
}

TEST_F(JudgeTest, SeesAGoalBeyondTheLimitsThoughNobodyToldIt) {
  seen[0].goal = 4000;
  Look(milliseconds(1));
  EXPECT_EQ(judge->Count(Rule::kLimits), 1U);
  EXPECT_EQ(judge->Count(Rule::kStrange), 1U);
}

TEST_F(JudgeTest, SeesAStepThatIsTooLarge) {
  rig.servos[0].max_acceleration_per_s2 = 0;
  Start();
  Tell(0, 2048 + 31);
  EXPECT_GE(judge->Count(Rule::kSpeed), 1U);
}

TEST_F(JudgeTest, SeesATurnThatIsTooSharp) {
  // 61440 counts/s^2: 6 counts a tick and tick, and 2 of rounding.
  Tell(0, 2048 + 9);
  ExpectOnly(Rule::kAcceleration);
}

TEST_F(JudgeTest, SeesAServoThatIsFasterThanItsOwnLimit) {
  Tell(0, 2050);
  seen[0].goal = 2050;
  seen[0].commanded = 2056;
  Look(milliseconds(1));
  ExpectOnly(Rule::kLeap);
}

TEST_F(JudgeTest, SeesAGoalThatNobodyTold) {
  seen[0].goal = 2049;
  Look(milliseconds(1));
  ExpectOnly(Rule::kStrange);
}

TEST_F(JudgeTest, ForgivesAForgeryOnlyWhereTheSumIsWeakAndTheLineIsBad) {
  judge = std::make_unique<Judge>(
      rig, std::vector<Wire>(2, {.step = 1, .reaction = milliseconds(12), .weak_sum = true}));
  Tick();
  seen[0].goal = 2060;
  judge->Unheard(0, now + milliseconds(1));
  Look(milliseconds(1));
  EXPECT_EQ(judge->Report(), "");
  EXPECT_EQ(judge->forged(), 1U);
  seen[0].goal = 2061;
  Look(milliseconds(1));
  ExpectOnly(Rule::kStrange);
}

TEST_F(JudgeTest, SeesALeapOverWordsThatTheLineLostOnlyWhereTheWordsWereTooFast) {
  Tell(0, 2050);
  Tell(0, 2053);
  seen[0].goal = seen[0].commanded = seen[0].sensed = 2053;
  Look(milliseconds(1));
  EXPECT_EQ(judge->Report(), "");
}

TEST_F(JudgeTest, SeesMotionAfterAStop) {
  rig.contract.stop_torque = std::chrono::seconds(1);
  Start();
  Tell(0, 2049);
  judge->Stopped(now);
  Look(milliseconds(14));
  seen[0].goal = 2049;
  Look(milliseconds(1));
  ExpectOnly(Rule::kMotionAfterStop);
  Tell(0, 2050);
  EXPECT_EQ(judge->Count(Rule::kMotionAfterStop), 2U);
}

TEST_F(JudgeTest, SeesTorqueAfterAStop) {
  judge->Stopped(now);
  Look(milliseconds(13));
  EXPECT_EQ(judge->Report(), "");
  Look(milliseconds(1));
  ExpectOnly(Rule::kTorqueAfterStop);
}

TEST_F(JudgeTest, SeesTorqueAfterTheContract) {
  const servo::Contract& c = rig.contract;
  const Time due = now - kTick + c.fresh + c.hold + c.ease + c.limp;
  Look(due + milliseconds(13) - now);
  EXPECT_EQ(judge->Report(), "");
  Look(milliseconds(1));
  ExpectOnly(Rule::kTorqueAfterContract);
}

TEST_F(JudgeTest, SeesTorqueOfAServoForWhichNobodyEverWished) {
  Judge fresh(rig, std::vector<Wire>(2));
  fresh.Look(now, seen);
  EXPECT_EQ(fresh.Count(Rule::kTorqueAfterContract), 2U);
}

TEST_F(JudgeTest, ForgivesAServoThatCouldNotHearUntilItCan) {
  judge->Stopped(now);
  judge->Unheard(0, now + milliseconds(100));
  judge->Unheard(1, now + milliseconds(100));
  Look(milliseconds(112));
  EXPECT_EQ(judge->Report(), "");
  Look(milliseconds(2));
  ExpectOnly(Rule::kTorqueAfterStop);
}

TEST_F(JudgeTest, SeesABrokenLinkageInWhatIsTold) {
  Tell(1, 2049);
  ExpectOnly(Rule::kLinkage);
}

TEST_F(JudgeTest, SeesABrokenLinkageAtTheBus) {
  seen[1].goal = 2048 + 200;
  Look(milliseconds(1));
  EXPECT_EQ(judge->Count(Rule::kLinkage), 1U);
  EXPECT_EQ(judge->Count(Rule::kStrange), 1U);
}

}  // namespace
}  // namespace facewire::stage
