#include "core/limit/motion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace facewire::limit {
namespace {

constexpr MotionLimits kGentle{.max_speed_per_s = 2, .max_acceleration_per_s2 = 4};

TEST(MoveTowards, SpeedsUpCruisesAndBrakes) {
  // 0 -> 3: half a second up (0.5), one second at 2 (2.0), half a second down (0.5).
  EXPECT_DOUBLE_EQ(MoveTowards(3, {}, kGentle, 0.25).position, 0.125);
  EXPECT_DOUBLE_EQ(MoveTowards(3, {}, kGentle, 0.25).speed_per_s, 1);
  EXPECT_DOUBLE_EQ(MoveTowards(3, {}, kGentle, 1).position, 1.5);
  EXPECT_DOUBLE_EQ(MoveTowards(3, {}, kGentle, 1).speed_per_s, 2);
  EXPECT_DOUBLE_EQ(MoveTowards(3, {}, kGentle, 1.75).position, 2.875);
  EXPECT_EQ(MoveTowards(3, {}, kGentle, 2).position, 3);
  EXPECT_EQ(MoveTowards(3, {}, kGentle, 100).speed_per_s, 0);
}

TEST(MoveTowards, ANearTargetIsReachedWithoutCruising) {
  EXPECT_DOUBLE_EQ(MoveTowards(-1, {}, kGentle, 0.5).position, -0.5);
  EXPECT_DOUBLE_EQ(MoveTowards(-1, {}, kGentle, 0.5).speed_per_s, -2);
  EXPECT_EQ(MoveTowards(-1, {}, kGentle, 1.0001).position, -1);
}

TEST(MoveTowards, TooFastToStopItBrakesAndComesBack) {
  // Moving at 2, the target 0.1 ahead, 0.5 needed to stop.
  const Motion at_turn = MoveTowards(0.1, {0, 2}, kGentle, 0.5);
  EXPECT_NEAR(at_turn.position, 0.5, 1e-12);
  EXPECT_NEAR(at_turn.speed_per_s, 0, 1e-12);
  EXPECT_EQ(MoveTowards(0.1, {0, 2}, kGentle, 5).position, 0.1);
}

TEST(MoveTowards, WithoutLimitsItIsThereAtOnceEvenInNoTime) {
  EXPECT_EQ(MoveTowards(7, {1, 0}, {}, 0).position, 7);
}

TEST(MoveTowards, ASpeedLimitAloneGivesStraightLines) {
  const MotionLimits limits{.max_speed_per_s = 2};
  EXPECT_DOUBLE_EQ(MoveTowards(7, {1, 0}, limits, 0.5).position, 2);
  EXPECT_EQ(MoveTowards(1.5, {1, 0}, limits, 0.5).position, 1.5);
}

TEST(MoveTowards, AnAccelerationLimitAloneHasNoCruise) {
  const MotionLimits limits{.max_acceleration_per_s2 = 4};
  EXPECT_DOUBLE_EQ(MoveTowards(16, {}, limits, 2).position, 8);
  EXPECT_DOUBLE_EQ(MoveTowards(16, {}, limits, 2).speed_per_s, 8);
  EXPECT_NEAR(MoveTowards(16, {}, limits, 3).position, 14, 1e-12);
}

TEST(MoveTowards, InNoTimeNothingMoves) {
  const Motion from{0.3, 1.1};
  EXPECT_EQ(MoveTowards(5, from, kGentle, 0).position, from.position);
  EXPECT_EQ(MoveTowards(5, from, kGentle, 0).speed_per_s, from.speed_per_s);
}

TEST(MoveTowards, ALongStepEndsWhereManyShortOnesDo) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> place(-3, 3);
  std::uniform_real_distribution<double> speed(-2, 2);
  std::uniform_real_distribution<double> part(0, 1);
  for (int trial = 0; trial < 2000; ++trial) {
    const Motion from{place(random), speed(random)};
    const double target = place(random);
    const double total_s = 4 * part(random);
    Motion many = from;
    for (double left_s = total_s; left_s > 0;) {
      const double step_s = left_s < 1e-3 ? left_s : left_s * part(random);
      many = MoveTowards(target, many, kGentle, step_s);
      left_s -= step_s;
    }
    const Motion one = MoveTowards(target, from, kGentle, total_s);
    ASSERT_NEAR(many.position, one.position, 1e-9) << "trial " << trial;
    ASSERT_NEAR(many.speed_per_s, one.speed_per_s, 1e-6) << "trial " << trial;
  }
}

}  // namespace
}  // namespace facewire::limit
