#include "core/servo/mapper.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/core/servo/generated_servos.h"

namespace facewire::servo {
namespace {

// A rig of the channels "a" and "b", and a servo that the test describes.
class MapperTest : public testing::Test {
 protected:
  MapperTest() {
    for (const char* name : {"a", "b"}) {
      Channel channel;
      channel.name = *ShortName::From(name);
      (void)character_.channels.try_push(channel);
    }
    servo_.map.clear();
  }
  void Source(const char* channel, float gain) {
    (void)servo_.sources.try_push({*ShortName::From(channel), gain});
  }
  void Point(float in, float out) { (void)servo_.map.try_push({in, out}); }
  Result<> Configure() {
    ServoRig rig;
    (void)rig.servos.try_push(servo_);
    return mapper_.Configure(rig, character_);
  }
  float Map(float a, float b, std::size_t count = 2) {
    RigPose pose{.seq = 7, .captured = Time(std::chrono::seconds(3)), .count = count};
    pose.values[0] = a;
    pose.values[1] = b;
    const Wishes wishes = mapper_.Map(pose);
    EXPECT_EQ(wishes.count, 1U);
    EXPECT_EQ(wishes.seq, 7U);
    EXPECT_EQ(wishes.captured, pose.captured);
    return wishes.positions[0];
  }

  Rig character_;
  Servo servo_ = PulseServo("jaw", 0);
  Mapper mapper_;
};

TEST_F(MapperTest, AddsTheSourcesAndAnOffset) {
  Source("b", 2);
  Source("a", -1);
  servo_.offset = 5;
  Point(0, 1000);
  Point(10, 2000);
  ASSERT_TRUE(Configure());
  EXPECT_EQ(Map(1, 0.5F), 1000 + 100 * (5 + 1 - 1));
}

TEST_F(MapperTest, TheOrderOfThePointsIsTheDirection) {
  Source("a", 1);
  Point(-1, 1900);
  Point(1, 1100);
  ASSERT_TRUE(Configure());
  EXPECT_EQ(Map(-1, 0), 1900);
  EXPECT_EQ(Map(0, 0), 1500);
  EXPECT_EQ(Map(1, 0), 1100);
}

TEST_F(MapperTest, ACurveIsMonotoneInBothDirections) {
  for (const bool falls : {false, true}) {
    servo_.map.clear();
    servo_.sources.clear();
    Source("a", 1);
    for (const CurvePoint p : {CurvePoint{0, 1100}, {1, 1150}, {2, 1800}, {3, 1800}}) {
      Point(p.in, falls ? 3000 - p.out : p.out);
    }
    ASSERT_TRUE(Configure());
    float before = Map(-1, 0);
    EXPECT_EQ(before, falls ? 1900 : 1100);
    for (float a = 0; a < 4; a += 0.01F) {
      const float now = Map(a, 0);
      EXPECT_GE(falls ? before - now : now - before, 0) << a;
      before = now;
    }
    EXPECT_EQ(before, falls ? 1200 : 1800);
  }
}

TEST_F(MapperTest, NothingPassesTheLimits) {
  Source("a", 1);
  Point(0, 500);
  Point(1, 2500);
  ASSERT_TRUE(Configure());
  EXPECT_EQ(Map(0, 0), 1000);
  EXPECT_EQ(Map(1, 0), 2000);
  EXPECT_EQ(Map(kInfinity, 0), 2000);
  EXPECT_EQ(Map(-kInfinity, 0), 1000);
  EXPECT_EQ(Map(3e38F, 0), 2000);
}

TEST_F(MapperTest, WhatIsNoNumberIsNoWish) {
  Source("a", 1);
  Source("b", -1);
  Point(0, 1000);
  Point(1, 2000);
  ASSERT_TRUE(Configure());
  EXPECT_TRUE(std::isnan(Map(kNan, 0)));
  EXPECT_TRUE(std::isnan(Map(0, 0, 1))) << "a channel is missing";
  EXPECT_TRUE(std::isnan(Map(kInfinity, kInfinity)));
  EXPECT_EQ(Map(0.5F, 0), 1500);
}

TEST_F(MapperTest, AServoWithoutSourcesHasNoWish) {
  ASSERT_TRUE(Configure());
  EXPECT_TRUE(std::isnan(Map(1, 1)));
}

TEST_F(MapperTest, RefusesAFlawAndGoesOnAsBefore) {
  Source("a", 1);
  Point(0, 1000);
  Point(1, 2000);
  ASSERT_TRUE(Configure());
  Source("c", 1);
  EXPECT_EQ(Configure().error(), Errc::kNotFound);
  servo_.max_speed_per_s = 0;
  EXPECT_EQ(Configure().error(), Errc::kOutOfRange);
  EXPECT_EQ(Map(0.5F, 0), 1500);
}

}  // namespace
}  // namespace facewire::servo
