#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <random>

#include "tests/tools/firmware/firmware.h"

namespace facewire::firmware {
namespace {

constexpr double kTicksPerS = 1000.0 / FW_TICK_MS;
constexpr double kPositionsPerUs = 4.0 * FW_PER_QUARTER;

FwServo TestServo() {
  return {.min = 4 * 1000,
          .neutral = 4 * 1500,
          .max = 4 * 2000,
          .speed = 4000,
          .ramp_speed = 500,
          .ramp_acceleration = 200};
}

FwMotion At(int us) {
  FwMotion motion = {};
  motion.position = FwPosition(static_cast<std::uint16_t>(4 * us));
  return motion;
}
int Us(const FwMotion& motion) {
  return static_cast<int>(std::lround(motion.position / kPositionsPerUs));
}

TEST(Motion, FollowsAtItsSpeedAndNoFaster) {
  const FwServo servo = TestServo();
  const FwLimits limits = FwLimitsOf(&servo);
  FwMotion motion = At(1500);
  FwMotionFollow(&motion, &limits, FwPosition(4 * 1700));
  EXPECT_EQ(Us(motion), 1580);  // 4000 us/s for 20 ms
  FwMotionFollow(&motion, &limits, FwPosition(4 * 1590));
  EXPECT_EQ(Us(motion), 1590);
}

TEST(Motion, NeverLeavesItsRange) {
  const FwServo servo = TestServo();
  const FwLimits limits = FwLimitsOf(&servo);
  FwMotion motion = At(1990);
  FwMotionFollow(&motion, &limits, FwPosition(FW_MAX_PULSE));
  EXPECT_EQ(Us(motion), 2000);
  motion = At(1010);
  for (int i = 0; i < 100; ++i) FwMotionRamp(&motion, &limits, 0);
  EXPECT_EQ(Us(motion), 1000);
}

TEST(Motion, ARampRisesRunsAndStopsAtItsGoalInTheTimeOfATrapezoid) {
  const FwServo servo = TestServo();
  const FwLimits limits = FwLimitsOf(&servo);
  FwMotion motion = At(1500);
  int ticks = 0;
  while (!motion.caught_up && ticks < 1000) {
    FwMotionRamp(&motion, &limits, FwPosition(4 * 2000));
    ++ticks;
  }
  // 500 us at 500 us/s and 2000 us/s^2: 1 s + 0.25 s.
  EXPECT_NEAR(ticks / kTicksPerS, 1.25, 0.08);
  for (int i = 0; i < 20; ++i) FwMotionRamp(&motion, &limits, FwPosition(4 * 2000));
  EXPECT_EQ(motion.position, FwPosition(4 * 2000));
  EXPECT_EQ(motion.velocity, 0);
}

TEST(Motion, ARampCatchesUpWithAGoalThatSwingsFasterThanItselfWhenItComesAcross) {
  const FwServo servo = TestServo();
  const FwLimits limits = FwLimitsOf(&servo);
  for (int phase = 0; phase < 100; ++phase) {
    FwMotion motion = At(1500);
    int ticks = 0;
    while (!motion.caught_up && ticks < 1000) {
      const double turns = ticks / kTicksPerS * 2 + phase / 100.0;
      const double us = 1500 + 300 * std::sin(2 * 3.14159 * turns);
      FwMotionRamp(&motion, &limits, static_cast<std::int32_t>(us * kPositionsPerUs));
      ++ticks;
    }
    EXPECT_LE(ticks / kTicksPerS, 0.6) << phase;  // little more than one swing
  }
}

TEST(Motion, ARampKeepsItsSpeedItsAccelerationAndItsRangeWhateverItsGoalDoes) {
  std::mt19937 random(17);
  const auto any = [&](int low, int high) {
    return std::uniform_int_distribution(low, high)(random);
  };
  for (int round = 0; round < 3000; ++round) {
    FwServo servo;
    servo.min = static_cast<std::uint16_t>(any(FW_MIN_PULSE, FW_MAX_PULSE));
    servo.max = static_cast<std::uint16_t>(any(servo.min, FW_MAX_PULSE));
    servo.neutral = static_cast<std::uint16_t>(any(servo.min, servo.max));
    const int most = any(0, 1) == 0 ? 1000 : 65535;
    servo.speed = static_cast<std::uint16_t>(any(1, most));
    servo.ramp_speed = static_cast<std::uint16_t>(any(1, most));
    servo.ramp_acceleration = static_cast<std::uint16_t>(any(1, most));
    const FwLimits limits = FwLimitsOf(&servo);
    FwMotion motion = {};
    motion.position = FwPosition(servo.neutral);
    const double speed = std::min(servo.speed, servo.ramp_speed) / kTicksPerS * kPositionsPerUs;
    const double acceleration =
        servo.ramp_acceleration * 10.0 / kTicksPerS / kTicksPerS * kPositionsPerUs;
    std::int32_t moved = 0;
    std::int32_t goal = motion.position;
    for (int tick = 0; tick < 200; ++tick) {
      if (any(0, 20) == 0) goal = any(0, FwPosition(0xFFFF));
      const std::int32_t before = motion.position;
      FwMotionRamp(&motion, &limits, goal);
      const std::int32_t move = motion.position - before;
      ASSERT_LE(std::abs(move), speed) << round;
      ASSERT_GE(motion.position, FwPosition(servo.min));
      ASSERT_LE(motion.position, FwPosition(servo.max));
      // The range comes first: at its end a servo may stop at once.
      const bool at_an_end =
          motion.position == FwPosition(servo.min) || motion.position == FwPosition(servo.max);
      ASSERT_TRUE(at_an_end || std::abs(move - moved) <= acceleration)
          << round << ' ' << moved << ' ' << move << ' ' << acceleration;
      moved = move;
    }
  }
}

TEST(Motion, AnEaseIsAtNeutralWhenItsTimeIsOver) {
  const FwServo servo = TestServo();
  const FwLimits limits = FwLimitsOf(&servo);
  FwMotion motion = At(2000);
  motion.eased_from = motion.position;
  int fastest = 0;
  for (std::uint32_t t = 0; t < 1000; t += FW_TICK_MS) {
    const int before = motion.position;
    FwMotionEase(&motion, &limits, t, 1000);
    ASSERT_LE(motion.position, before);
    fastest = std::max(fastest, before - motion.position);
    if (t == 500) {
      EXPECT_NEAR(Us(motion), 1750, 1);
    }
  }
  EXPECT_NEAR(Us(motion), 1500, 2);
  FwMotionEase(&motion, &limits, 1000, 1000);
  EXPECT_EQ(Us(motion), 1500);
  // 1.5 times the mean speed in the middle, none at the ends.
  EXPECT_NEAR(fastest * kTicksPerS / kPositionsPerUs, 750, 20);
}

TEST(Motion, AnEaseThatLeavesNoTimeStillKeepsTheSpeed) {
  const FwServo servo = TestServo();
  const FwLimits limits = FwLimitsOf(&servo);
  FwMotion motion = At(2000);
  motion.eased_from = motion.position;
  FwMotionEase(&motion, &limits, 0, 0);
  EXPECT_EQ(Us(motion), 1920);
}

TEST(Motion, TheLongestEaseOfTheWidestRangeDoesNotOverflow) {
  FwServo servo = TestServo();
  servo.min = servo.neutral = FW_MIN_PULSE;
  servo.max = FW_MAX_PULSE;
  servo.speed = 0xFFFF;
  const FwLimits limits = FwLimitsOf(&servo);
  FwMotion motion = At(2500);
  motion.eased_from = motion.position;
  FwMotionEase(&motion, &limits, 0xFFFFFFFE / 2, 0xFFFFFFFF);
  EXPECT_NEAR(Us(motion), 1500, 2);
  FwMotionEase(&motion, &limits, 0xFFFFFFFE, 0xFFFFFFFF);
  EXPECT_NEAR(Us(motion), 500, 2);
}

}  // namespace
}  // namespace facewire::firmware
