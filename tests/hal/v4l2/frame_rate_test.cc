#include "hal/v4l2/frame_rate.h"

#include <gtest/gtest.h>

namespace facewire::hal::v4l2 {
namespace {

TEST(FrameRates, NearestIsByRatioAndOfTwoTheFaster) {
  const FrameRates rates{.periods = {{1, 60}, {1, 30}, {1, 15}, {2, 15}}};
  const struct {
    double wanted, nearest;
  } rows[] = {{30, 30}, {29, 30}, {20, 15}, {22, 30}, {500, 60}, {1, 7.5}};
  for (const auto& row : rows) EXPECT_DOUBLE_EQ(rates.Nearest(row.wanted).fps(), row.nearest);
  const FrameRates gap{.periods = {{1, 15}, {1, 60}}};
  EXPECT_DOUBLE_EQ(gap.Nearest(30).fps(), 60);
}

TEST(FrameRates, WithinARangeEveryRateCanBeHad) {
  const FrameRates rates{.periods = {{1, 60}, {1, 5}}, .range = true};
  EXPECT_NEAR(rates.Nearest(24).fps(), 24, 0.001);
  EXPECT_DOUBLE_EQ(rates.Nearest(100).fps(), 60);
  EXPECT_DOUBLE_EQ(rates.Nearest(1).fps(), 5);
}

TEST(FrameRates, WhatTheDeviceDoesNotSayIsUnknown) {
  EXPECT_EQ(FrameRates{}.Nearest(30).denominator, 0U);
  EXPECT_DOUBLE_EQ(Period{}.fps(), 0);
}

}  // namespace
}  // namespace facewire::hal::v4l2
