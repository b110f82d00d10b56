#include "core/rig/response.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <random>
#include <vector>

#include "core/rig/rig.h"

namespace facewire {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kHuge = std::numeric_limits<float>::max();

Response Curve(std::initializer_list<CurvePoint> points) {
  Response response;
  for (const CurvePoint& point : points) EXPECT_TRUE(response.curve.try_push(point));
  return response;
}

Channel Bounded(float min, float neutral, float max, float knee) {
  Channel channel;
  channel.min = min;
  channel.neutral = neutral;
  channel.max = max;
  channel.knee = knee;
  return channel;
}

TEST(Response, AsItStandsItChangesNothing) {
  for (const float sum : {0.F, 1.F, -0.3F, 1e-42F, 1e30F})
    EXPECT_EQ(Respond(Response{}, sum), double{sum});
}

TEST(Response, MultipliesByTheGainThenAddsTheBiasThenFollowsTheCurve) {
  Response response = Curve({{0, 0}, {10, 20}});
  response.gain = 2;
  response.bias = 1;
  EXPECT_DOUBLE_EQ(Respond(response, 3), 14);
  EXPECT_DOUBLE_EQ(Respond(response, 0), 2) << "a neutral face is where bias and curve put it";
}

TEST(Response, TwoPointsAreAStraightLineWithStops) {
  const Response response = Curve({{0, 5}, {10, 25}});
  EXPECT_DOUBLE_EQ(Respond(response, 2.5), 10);
  EXPECT_DOUBLE_EQ(Respond(response, -1e30), 5);
  EXPECT_DOUBLE_EQ(Respond(response, 1e30), 25);
  EXPECT_DOUBLE_EQ(Respond(response, kInfinity), 25);
}

TEST(Response, GoesThroughItsPoints) {
  const Response response = Curve({{-1, -4}, {0, 0}, {0.5F, 0.1F}, {2, 7}});
  for (const CurvePoint& point : response.curve)
    EXPECT_DOUBLE_EQ(Respond(response, point.in), point.out) << point.in;
}

TEST(Response, TwoEqualOutsAreADeadZone) {
  const Response response = Curve({{-1, -1}, {-0.1F, 0}, {0.1F, 0}, {1, 1}});
  for (const float sum : {-0.1F, -0.05F, 0.F, 0.0999F, 0.1F}) EXPECT_EQ(Respond(response, sum), 0);
  EXPECT_GT(Respond(response, 0.2), 0);
  EXPECT_LT(Respond(response, -0.2), 0);
}

// scipy.interpolate.PchipInterpolator([0, 1, 3, 4], [0, 1, 2, 6]) between the inner points, whose
// slopes do not depend on the choice at the ends.
TEST(Response, IsAsSciPyHasItBetweenInnerPoints) {
  const Response response = Curve({{0, 0}, {1, 1}, {3, 2}, {4, 6}});
  EXPECT_NEAR(Respond(response, 1.5), 1.2597453222453225, 1e-9);
  EXPECT_NEAR(Respond(response, 2), 1.42983367983368, 1e-9);
  EXPECT_NEAR(Respond(response, 2.75), 1.7897284303534304, 1e-9);
}

TEST(Response, NanStaysNan) {
  EXPECT_TRUE(std::isnan(Respond(Response{}, kNan)));
  EXPECT_TRUE(std::isnan(Respond(Curve({{0, 0}, {1, 1}}), kNan)));
}

TEST(SoftKnee, IsIdentityBelowItAndReachesTheLimitAsFarBeyondAsItBegan) {
  EXPECT_EQ(ApproachFromBelow(7.9, 10, 2), 7.9);
  EXPECT_EQ(ApproachFromBelow(8, 10, 2), 8);
  EXPECT_DOUBLE_EQ(ApproachFromBelow(10, 10, 2), 9.5) << "a quarter of the width short";
  EXPECT_EQ(ApproachFromBelow(12, 10, 2), 10);
  EXPECT_EQ(ApproachFromBelow(1e30, 10, 2), 10);
  EXPECT_EQ(ApproachFromBelow(11, 10, 0), 10) << "no width: a hard stop";
}

TEST(SoftKnee, HasNoCorner) {
  constexpr double kStep = 1e-5;
  double slope = 1;
  for (double x = 7; x < 13; x += 0.01) {
    const double next = (ApproachFromBelow(x + kStep, 10, 2) - ApproachFromBelow(x, 10, 2)) / kStep;
    EXPECT_NEAR(next, slope, 0.01) << x;
    EXPECT_LE(next, slope + 1e-6) << x;
    slope = next;
  }
  EXPECT_NEAR(slope, 0, 1e-9);
}

TEST(ChannelValue, WithoutAKneeTheLimitsAreLeftToTheLimiter) {
  const Channel channel = Bounded(0, 0.25F, 1, 0);
  EXPECT_EQ(channel.ValueOf(0.75F), 1.F) << "a weight of 1 is reached exactly";
  EXPECT_EQ(channel.ValueOf(3), 3.25F);
}

TEST(ChannelValue, WithAKneeItApproachesBothLimits) {
  const Channel channel = Bounded(-10, 0, 10, 0.1F);  // knees of 2 on either side of the limits
  EXPECT_EQ(channel.ValueOf(8), 8.F);
  EXPECT_EQ(channel.ValueOf(-8), -8.F);
  EXPECT_FLOAT_EQ(channel.ValueOf(10), 9.5F);
  EXPECT_FLOAT_EQ(channel.ValueOf(-10), -9.5F);
  EXPECT_EQ(channel.ValueOf(12), 10.F);
  EXPECT_EQ(channel.ValueOf(kHuge), 10.F);
  EXPECT_EQ(channel.ValueOf(-kHuge), -10.F);
}

TEST(ChannelValue, AtRestItIsAtNeutralHoweverNearALimitThatIs) {
  for (const float neutral : {-10.F, -9.9F, 0.F, 9.5F, 10.F})
    EXPECT_EQ(Bounded(-10, neutral, 10, 0.5F).ValueOf(0), neutral);
  EXPECT_EQ(Bounded(0, 0, 10, 0.1F).ValueOf(0.25F), 0.25F) << "no knee where it rests on a limit";
  EXPECT_EQ(Bounded(0, 0, 10, 0.1F).ValueOf(-5), 0.F);
}

TEST(ChannelValue, WhatIsNotANumberIsNeutral) {
  Channel channel = Bounded(-10, 3, 10, 0.1F);
  channel.response.bias = 2;
  EXPECT_EQ(channel.ValueOf(0), 5.F);
  for (const float broken : {kNan, kInfinity, -kInfinity}) EXPECT_EQ(channel.ValueOf(broken), 3.F);
  channel.response.gain = kNan;
  EXPECT_EQ(channel.ValueOf(1), 3.F);
}

TEST(ChannelValue, AnOverflowIsStillANumber) {
  Channel channel = Bounded(-10, 0, 10, 0);
  channel.response.gain = 1000;
  EXPECT_EQ(channel.ValueOf(kHuge), kHuge);
  EXPECT_EQ(channel.ValueOf(-kHuge), -kHuge);
}

// What holds for every channel that a rig file may hold.
class ChannelProperty : public testing::TestWithParam<unsigned> {
 protected:
  float Between(float a, float b) { return std::uniform_real_distribution<float>(a, b)(random_); }
  bool Chance(int one_in) { return std::uniform_int_distribution<int>(1, one_in)(random_) == 1; }

  Channel RandomChannel() {
    const float size = std::pow(10.F, Between(-2, 3));
    const float min = Between(-size, size);
    const float max = Between(min, size);
    const float neutral = Chance(3) ? (Chance(2) ? min : max) : Between(min, max);
    Channel channel = Bounded(min, neutral, max, Between(0.001F, 0.5F));
    channel.response.gain = Between(-3, 3);
    channel.response.bias = Between(-size, size);
    if (Chance(2)) AddCurve(channel.response, size);
    return channel;
  }
  void AddCurve(Response& response, float size) {
    CurvePoint point{Between(-2 * size, 0), Between(-2 * size, 0)};
    const int count = std::uniform_int_distribution<int>(2, kMaxCurvePoints)(random_);
    for (int i = 0; i < count; ++i) {
      ASSERT_TRUE(response.curve.try_push(point));
      point.in += Between(0.01F, 1) * size;
      if (!Chance(3)) point.out += Between(0, 1) * size;
    }
  }
  std::mt19937 random_{GetParam()};
};

TEST_P(ChannelProperty, IsMonotoneContinuousAndInsideItsLimits) {
  for (int trial = 0; trial < 200; ++trial) {
    const Channel channel = RandomChannel();
    const float range = channel.max - channel.min;
    const float size = std::max({std::abs(channel.min), std::abs(channel.max), range});
    const float sign = channel.response.gain < 0 ? -1.F : 1.F;
    // No response is steeper than its gain times three times its steepest secant (Fritsch,
    // Carlson).
    double steepest = channel.response.curve.empty() ? 1 : 0;
    for (std::size_t i = 1; i < channel.response.curve.size(); ++i) {
      const CurvePoint& a = channel.response.curve[i - 1];
      const CurvePoint& b = channel.response.curve[i];
      steepest = std::max(steepest, 3 * (double{b.out} - a.out) / (double{b.in} - a.in));
    }
    const double slope = steepest * std::abs(double{channel.response.gain});
    const double rounding = 1e-6 * double{size};
    float last = channel.ValueOf(-10 * size);
    for (int i = -1000; i <= 1000; ++i) {
      const float value = channel.ValueOf(0.01F * static_cast<float>(i) * size);
      ASSERT_GE(value, channel.min);
      ASSERT_LE(value, channel.max);
      ASSERT_GE(sign * (value - last), -rounding);
      ASSERT_LE(std::abs(double{value} - last), slope * 0.0101 * double{size} + rounding);
      last = value;
    }
    for (const float wild : {kNan, kInfinity, -kInfinity, kHuge, -kHuge, 1e-42F}) {
      ASSERT_GE(channel.ValueOf(wild), channel.min);
      ASSERT_LE(channel.ValueOf(wild), channel.max);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, ChannelProperty, testing::Range(0U, 8U));

}  // namespace
}  // namespace facewire
