#include "core/servo/axis.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "tests/core/servo/generated_servos.h"

namespace facewire::servo {
namespace {

constexpr double kFar = std::numeric_limits<double>::max();
constexpr Span kAnywhere{-kFar, kFar};

Servo Slow(float speed, float acceleration = 0) {
  Servo servo = CountServo("jaw", 1);
  servo.max_speed_per_s = speed;
  servo.max_acceleration_per_s2 = acceleration;
  servo.crawl_speed_per_s = speed / 10;
  return servo;
}

TEST(Axis, StartsAtNeutralOnAWholeStep) {
  Servo servo = PulseServo("jaw", 1);
  servo.neutral = 1500.2F;
  Axis axis;
  ASSERT_TRUE(axis.Configure(servo, 0.25));
  EXPECT_EQ(axis.command(), 1500.25);
  EXPECT_EQ(axis.position(), 1500.25) << "the motion begins where the command is";
}

TEST(Axis, RoundsItsLimitsInwards) {
  Servo servo = PulseServo("jaw", 1);
  servo.min = 1000.1F;
  servo.max = 1999.9F;
  Axis axis;
  ASSERT_TRUE(axis.Configure(servo, 0.25));
  axis.Place(0);
  EXPECT_EQ(axis.command(), 1000.25);
  axis.Place(5000);
  EXPECT_EQ(axis.command(), 1999.75);
}

TEST(Axis, RefusesALimitWithoutAnyWholeStep) {
  Servo servo = PulseServo("jaw", 1);
  servo.min = 1500.1F;
  servo.neutral = servo.max = 1500.9F;
  Axis axis;
  EXPECT_FALSE(axis.Configure(servo, 1));
  EXPECT_TRUE(axis.Configure(servo, 0.25));
}

TEST(Axis, ATickMovesByNoMoreWholeStepsThanItsSpeedAllows) {
  // 1.5 counts a tick: rounded one by one they would be 2, 1, 2, 1.
  Axis axis;
  ASSERT_TRUE(axis.Configure(Slow(150), 1));
  double before = axis.command();
  for (int tick = 0; tick < 100; ++tick) {
    axis.Move(3000, kAnywhere, 0.01);
    EXPECT_LE(axis.command() - before, 1.5);
    before = axis.command();
  }
  EXPECT_EQ(before, 2048 + 100) << "one whole count a tick";
}

TEST(Axis, WhatIsSlowerThanOneStepATickMovesWhenAStepIsDue) {
  // 0.3 counts a tick: a count after 3.33 ticks, so after 4.
  Axis axis;
  ASSERT_TRUE(axis.Configure(Slow(30), 1));
  double before = axis.command();
  int since = 0;
  for (int tick = 0; tick < 200; ++tick) {
    axis.Move(3000, kAnywhere, 0.01);
    ++since;
    if (axis.command() == before) continue;
    EXPECT_EQ(axis.command(), before + 1);
    EXPECT_GE(30 * 0.01 * since, 1 - 1e-9);
    before = axis.command();
    since = 0;
  }
  EXPECT_EQ(before, 2048 + 50);
}

TEST(Axis, ArrivesExactlyAndStaysThere) {
  Axis axis;
  ASSERT_TRUE(axis.Configure(PulseServo("jaw", 1), 0.25));
  for (int tick = 0; tick < 100; ++tick) axis.Move(1733.25, kAnywhere, 0.01);
  EXPECT_EQ(axis.command(), 1733.25);
  EXPECT_EQ(axis.position(), 1733.25);
  EXPECT_EQ(axis.reach().low, axis.reach().high) << "it stands";
}

TEST(Axis, AGoalBetweenTwoStepsDoesNotMakeItSwing) {
  Axis axis;
  ASSERT_TRUE(axis.Configure(CountServo("jaw", 1), 1));
  for (int tick = 0; tick < 100; ++tick) axis.Move(2100.5, kAnywhere, 0.01);
  const double at = axis.command();
  EXPECT_NEAR(at, 2100.5, 0.5);
  for (int tick = 0; tick < 1000; ++tick) {
    axis.Move(2100.5, kAnywhere, 0.01);
    ASSERT_EQ(axis.command(), at);
  }
}

TEST(Axis, ACrawlIsSlowerAndGentlerByTheSameFactor) {
  Axis axis;
  ASSERT_TRUE(axis.Configure(Slow(1000, 10000), 1));
  axis.SetCrawl(true);
  double before = axis.command();
  for (int tick = 0; tick < 200; ++tick) {
    axis.Move(3000, kAnywhere, 0.01);
    EXPECT_LE(axis.command() - before, 1);
    // A tenth of the acceleration reaches a tenth of the speed in as much time: 0.1 s.
    if (tick == 9) {
      EXPECT_NEAR(axis.position(), 2048 + 0.5 * 1000 * 0.1 * 0.1, 0.51);
    }
    before = axis.command();
  }
}

TEST(Axis, LessVigourBrakesDownToTheNewSpeed) {
  Axis axis;
  ASSERT_TRUE(axis.Configure(Slow(1000, 2000), 1));
  axis.Place(1024);
  for (int tick = 0; tick < 60; ++tick) axis.Move(3072, kAnywhere, 0.01);
  axis.SetVigour(0.5);
  double before = axis.command();
  double speed = 1000;
  for (int tick = 0; tick < 60; ++tick) {
    axis.Move(3072, kAnywhere, 0.01);
    const double now = (axis.command() - before) / 0.01;
    EXPECT_GE(now, speed - 2000 * 0.01 - 2 * 100) << "no harder than it may brake, and two steps";
    EXPECT_LE(now, std::max(500.0, 1000 - 20.0 * (tick + 1)) + 1e-6);
    before = axis.command();
    speed = now;
  }
  EXPECT_NEAR(speed, 500, 1e-6);
}

TEST(Axis, AnEmptyRoomMakesItBrake) {
  Axis axis;
  ASSERT_TRUE(axis.Configure(Slow(1000, 2000), 1));
  for (int tick = 0; tick < 30; ++tick) axis.Move(3072, kAnywhere, 0.01);
  const Span reach = axis.reach();
  for (int tick = 0; tick < 60; ++tick) axis.Move(3072, {1, 0}, 0.01);
  EXPECT_NEAR(axis.command(), reach.high, 0.51);
}

TEST(Axis, WhateverItIsToldItKeepsItsLimits) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int servo = 0; servo < 60; ++servo) {
    Servo limits = servo % 2 == 0 ? PulseServo("jaw", 1) : CountServo("jaw", 1);
    const double step = servo % 2 == 0 ? 0.25 : 1;
    limits.max_speed_per_s = static_cast<float>(std::pow(10, 1 + 3 * unit(random)));
    limits.max_acceleration_per_s2 =
        limits.max_speed_per_s * static_cast<float>(2 + 30 * unit(random));
    limits.crawl_speed_per_s = limits.max_speed_per_s / 8;
    Axis axis;
    ASSERT_TRUE(axis.Configure(limits, step));
    const double dt = 1.0 / (50 + 150 * unit(random));
    const double speed = limits.max_speed_per_s;
    const double acceleration = limits.max_acceleration_per_s2;
    double goal = limits.neutral;
    double before = axis.command();
    double change = 0;
    double since = 0;
    for (int tick = 0; tick < 5000; ++tick) {
      if (unit(random) < 0.05) goal = 500 + 3000 * unit(random);
      if (unit(random) < 0.5) goal += 20 * (unit(random) - 0.5);
      axis.Move(goal, kAnywhere, dt);
      since += dt;
      const double now = axis.command() - before;
      EXPECT_GE(axis.command(), limits.min);
      EXPECT_LE(axis.command(), limits.max);
      EXPECT_EQ(axis.command(), std::round(axis.command() / step) * step);
      EXPECT_LE(std::abs(axis.command() - axis.position()), step / 2 + 1e-9);
      EXPECT_LE(std::abs(now),
                std::max(speed * dt, speed * since >= step - 1e-9 ? step : 0) + 1e-9);
      EXPECT_LE(std::abs(now - change), acceleration * dt * dt + 2 * step + 1e-6)
          << "servo " << servo << " tick " << tick;
      if (now != 0) since = 0;
      before = axis.command();
      change = now;
    }
  }
}

}  // namespace
}  // namespace facewire::servo
