#include "core/retarget/soft_range.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace facewire::retarget {
namespace {

constexpr SoftRange kShape{0, 1, 0};      // a blend shape
constexpr SoftRange kAngle{-10, 30, 0};   // rests inside its range
constexpr SoftRange kNearEnd{-1, 30, 0};  // nearer to an end than the knee
constexpr SoftRange kStill{0.5F, 0.5F, 0.5F};

TEST(SoftRange, IsExactInsideAndAtBothEnds) {
  for (const float x : {0.0F, 0.01F, 0.5F, 0.9F}) EXPECT_EQ(kShape.Limit(x), x);
  EXPECT_EQ(kShape.Limit(1), 1);
  for (const float x : {-10.0F, -5.9F, 0.0F, 25.9F, 30.0F}) EXPECT_EQ(kAngle.Limit(x), x);
  EXPECT_EQ(kNearEnd.Limit(0), 0);
  EXPECT_EQ(kNearEnd.Limit(-1), -1);
}

TEST(SoftRange, NeverLeavesTheRangeNeverFallsAndHasNoKinkOnTheWayUp) {
  for (const SoftRange& range : {kShape, kAngle, kNearEnd, kStill}) {
    const float step = 0.001F * (range.high - range.low) + 1e-6F;
    float before = range.Limit(range.low - 1);
    float slope_before = 0;
    for (float x = range.low - 1; x < range.high + 1; x += step) {
      const float y = range.Limit(x);
      EXPECT_GE(y, range.low);
      EXPECT_LE(y, range.high);
      EXPECT_GE(y, before);
      const float slope = (y - before) / step;
      if (x > range.neutral + 2 * step) {
        EXPECT_NEAR(slope, slope_before, 0.05F) << "at " << x;
      }
      slope_before = slope;
      before = y;
    }
  }
}

TEST(SoftRange, ADeadZoneFadesOutWithoutAKinkAndLeavesTheMiddleAndTheEnds) {
  constexpr SoftRange kDead{0, 1, 0, 0.1F};
  EXPECT_EQ(kDead.Limit(0), 0);
  EXPECT_LT(kDead.Limit(0.1F), 0.035F);
  EXPECT_NEAR(kDead.Limit(0.5F), 0.5F, 1e-6F);
  EXPECT_EQ(kDead.Limit(1), 1);
  EXPECT_LT(kDead.Limit(1e-3F), 1e-4F) << "flat at rest";
  const auto slope = [&](float x) { return (kDead.Limit(x + 1e-3F) - kDead.Limit(x)) / 1e-3F; };
  EXPECT_NEAR(slope(0.198F), slope(0.201F), 0.05F);
}

TEST(SoftRange, ADeadZoneIsOnBothSidesOfARestInside) {
  constexpr SoftRange kDead{-10, 30, 0, 0.1F};
  EXPECT_LT(std::abs(kDead.Limit(-1)), 0.5F);
  EXPECT_LT(kDead.Limit(3), 1.5F);
  EXPECT_NEAR(kDead.Limit(-5), -5, 1e-5F);
  EXPECT_NEAR(kDead.Limit(15), 15, 1e-5F);
}

TEST(SoftRange, ABlendShapeStaysAtRestBelowZero) { EXPECT_EQ(kShape.Limit(-0.3F), 0); }

TEST(SoftRange, WhatIsNotFiniteIsTheNeutral) {
  EXPECT_EQ(kNearEnd.Limit(std::numeric_limits<float>::quiet_NaN()), 0);
  EXPECT_EQ(kStill.Limit(std::numeric_limits<float>::infinity()), 0.5F);
}

}  // namespace
}  // namespace facewire::retarget
