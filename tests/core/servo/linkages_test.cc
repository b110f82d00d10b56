#include "core/servo/linkages.h"

#include <gtest/gtest.h>

#include <array>
#include <random>

#include "tests/core/servo/generated_servos.h"

namespace facewire::servo {
namespace {

constexpr double kTick = 0.01;

// The lid must stay at or above the eye less 100 us, in this rig; the lid yields.
class LinkagesTest : public testing::Test {
 protected:
  LinkagesTest() {
    (void)rig_.servos.try_push(PulseServo("lid", 0));
    (void)rig_.servos.try_push(PulseServo("eye", 1));
    AddRule(0, 1, Relation::kAtLeast, 1, -100);
  }
  void AddRule(std::uint8_t yields, std::uint8_t other, Relation relation, float gain,
               float offset) {
    Linkage linkage;
    linkage.name = *ShortName::From("rule");
    linkage.yields = yields;
    linkage.other = other;
    linkage.relation = relation;
    linkage.gain = gain;
    linkage.offset = offset;
    (void)rig_.linkages.try_push(linkage);
  }
  void Configure() {
    ASSERT_FALSE(FindFlaw(rig_));
    for (std::size_t i = 0; i < rig_.servos.size(); ++i) {
      ASSERT_TRUE(axes_[i].Configure(rig_.servos[i], 0.25));
    }
    linkages_.Configure(rig_, axes());
  }
  std::span<const Axis> axes() const { return {axes_.data(), rig_.servos.size()}; }
  void Tick() {
    for (const std::size_t i : linkages_.order()) {
      axes_[i].Move(linkages_.GiveWay(i, goals_), linkages_.Room(i, axes()), kTick);
    }
  }
  bool Holds() const {
    for (const Linkage& rule : rig_.linkages) {
      const double bound = rule.gain * axes_[rule.other].command() + rule.offset;
      const double at = axes_[rule.yields].command();
      if (rule.relation == Relation::kAtLeast ? at < bound : at > bound) return false;
    }
    return true;
  }
  double Lid() const { return axes_[0].command(); }
  double Eye() const { return axes_[1].command(); }

  ServoRig rig_;
  std::array<Axis, 3> axes_;
  std::array<double, 3> goals_{1500, 1500, 1500};
  Linkages linkages_;
};

TEST_F(LinkagesTest, TheLidMakesWayForTheEye) {
  Configure();
  goals_ = {1500, 1900};
  for (int tick = 0; tick < 200; ++tick) {
    Tick();
    ASSERT_TRUE(Holds()) << tick;
  }
  EXPECT_EQ(Eye(), 1900);
  EXPECT_GE(Lid(), 1800);
  EXPECT_LE(Lid(), 1800.5) << "no further than it must";
}

TEST_F(LinkagesTest, TheEyeWaitsForASlowLid) {
  rig_.servos[0].max_speed_per_s = 100;
  rig_.servos[0].crawl_speed_per_s = 100;
  Configure();
  goals_ = {1500, 1900};
  for (int tick = 0; tick < 150; ++tick) {
    Tick();
    ASSERT_TRUE(Holds()) << tick;
  }
  EXPECT_GT(Eye(), 1700) << "it follows as the lid goes";
  EXPECT_LT(Eye(), 1760);
  for (int tick = 0; tick < 200; ++tick) Tick();
  EXPECT_EQ(Eye(), 1900);
}

TEST_F(LinkagesTest, TheLidStopsAboveAnEyeThatCannotGo) {
  rig_.servos[1].max_speed_per_s = 1;
  rig_.servos[1].crawl_speed_per_s = 1;
  Configure();
  goals_ = {1000, 1500};
  for (int tick = 0; tick < 200; ++tick) {
    Tick();
    ASSERT_TRUE(Holds()) << tick;
  }
  EXPECT_NEAR(Lid(), 1400, 0.5);
}

TEST_F(LinkagesTest, AnEyeDoesNotPushALidBeyondItsEnd) {
  rig_.servos[0].max = 1600;
  Configure();
  goals_ = {1500, 1950};
  for (int tick = 0; tick < 200; ++tick) {
    Tick();
    ASSERT_TRUE(Holds()) << tick;
  }
  EXPECT_EQ(Lid(), 1600);
  EXPECT_NEAR(Eye(), 1700, 0.5);
}

TEST_F(LinkagesTest, WhatIsBrokenAtTheStartIsMendedFromBothSides) {
  Configure();
  axes_[0].Place(1100);  // somebody's hand
  axes_[1].Place(1800);
  goals_ = {1500, 1800};
  double lid = Lid();
  for (int tick = 0; tick < 200; ++tick) {
    Tick();
    if (!Holds()) {
      EXPECT_GE(Lid(), lid) << "never worse";
    }
    lid = Lid();
  }
  EXPECT_TRUE(Holds());
  EXPECT_EQ(Eye(), 1800);
}

TEST_F(LinkagesTest, NoRuleBreaksWhateverTheGoals) {
  // A lid above and a lid below the eye, one coupled the other way round, and to each other.
  (void)rig_.servos.try_push(PulseServo("lower", 2));
  AddRule(2, 1, Relation::kAtMost, -0.5F, 2300);
  AddRule(0, 2, Relation::kAtLeast, 1, -50);
  std::mt19937 random(11);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int round = 0; round < 50; ++round) {
    for (Servo& servo : rig_.servos) {
      servo.max_speed_per_s = static_cast<float>(50 + 5000 * unit(random));
      servo.crawl_speed_per_s = servo.max_speed_per_s / 5;
      servo.max_acceleration_per_s2 = round % 5 == 0 ? 0 : servo.max_speed_per_s * 10;
    }
    Configure();
    for (int tick = 0; tick < 4000; ++tick) {
      for (double& goal : goals_) {
        if (unit(random) < 0.03) goal = 900 + 1200 * unit(random);
      }
      if (unit(random) < 0.01) axes_[tick % 3].Freeze();
      if (unit(random) < 0.02) axes_[tick % 3].SetVigour(0.1 + 0.9 * unit(random));
      Tick();
      ASSERT_TRUE(Holds()) << round << ", " << tick;
    }
  }
}

}  // namespace
}  // namespace facewire::servo
