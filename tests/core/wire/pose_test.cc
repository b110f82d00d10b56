#include "core/wire/pose.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/wire/rig_description.h"
#include "tests/core/wire/test_rig.h"

namespace facewire::wire {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kHuge = std::numeric_limits<float>::max();

TEST(Quantise, TheEndsOfTheRangeAreExact) {
  EXPECT_EQ(Quantise(-45, 0, -45, 45), 0);
  EXPECT_EQ(Quantise(45, 0, -45, 45), 65535);
  EXPECT_EQ(Dequantise(0, -45, 45), -45.0F);
  EXPECT_EQ(Dequantise(65535, -45, 45), 45.0F);
  EXPECT_EQ(Dequantise(65535, 0.1F, 0.7F), 0.7F);
}

TEST(Quantise, AStepComesBackAsItself) {
  for (int step = 0; step <= 65535; ++step) {
    const auto s = static_cast<std::uint16_t>(step);
    ASSERT_EQ(Quantise(Dequantise(s, -2, 22.5F), 0, -2, 22.5F), s);
  }
}

TEST(Quantise, TheErrorIsAtMostHalfAStep) {
  for (float v = -2; v <= 22; v += 0.0137F) {
    const float back = Dequantise(Quantise(v, 0, -2, 22), -2, 22);
    ASSERT_LE(std::abs(back - v), 24.0F / 65535 / 2 * 1.01F) << v;
  }
}

TEST(Quantise, NoInputPassesTheRange) {
  EXPECT_EQ(Quantise(kHuge, 0, -1, 1), 65535);
  EXPECT_EQ(Quantise(kInfinity, 0, -1, 1), 65535);
  EXPECT_EQ(Quantise(-kHuge, 0, -1, 1), 0);
  EXPECT_EQ(Quantise(-kInfinity, 0, -1, 1), 0);
}

TEST(Quantise, NotANumberIsNeutral) {
  EXPECT_EQ(Quantise(kNan, 0, 0, 1), 0);
  EXPECT_EQ(Quantise(kNan, 1, 0, 1), 65535);
  EXPECT_EQ(Quantise(kNan, 0, -1, 1), Quantise(0, 0, -1, 1));
}

TEST(Quantise, RangesWithoutWidthOrSenseGiveZero) {
  EXPECT_EQ(Quantise(5, 4, 4, 4), 0);
  EXPECT_EQ(Dequantise(9, 4, 4), 4.0F);
  EXPECT_EQ(Quantise(5, 4, 6, 4), 0);
  EXPECT_EQ(Quantise(5, 4, kNan, 4), 0);
  EXPECT_EQ(Quantise(5, 4, 0, kInfinity), 0);
  EXPECT_EQ(Quantise(kNan, kNan, 0, 1), 0);
}

TEST(Quantise, TheWidestRangeDoesNotOverflow) {
  EXPECT_EQ(Quantise(kHuge, 0, -kHuge, kHuge), 65535);
  EXPECT_EQ(Dequantise(65535, -kHuge, kHuge), kHuge);
  EXPECT_EQ(Dequantise(0, -kHuge, kHuge), -kHuge);
}

TEST(MakePose, CarriesEveryValueToTheHost) {
  const Rig rig = TestRig();
  RigPose pose = rig.NeutralPose();
  pose.seq = 0x1'0000'0007;
  pose.captured = Time(Duration(500));
  pose.values = {10, -20, 0.25F, 0.75F};
  const Pose message = MakePose(rig, 99, pose, ServiceState::kTracking, Time(Duration(31'500)));
  EXPECT_EQ(message.rig_id, 99U);
  EXPECT_EQ(message.frame_seq, 7U);
  EXPECT_EQ(message.age_us, 31'000U);
  EXPECT_EQ(message.state, ServiceState::kTracking);
  const RigPose back = ValuesOf(message, rig);
  EXPECT_EQ(back.captured, pose.captured);
  ASSERT_EQ(back.count, 4U);
  EXPECT_NEAR(back.values[0], 10, 2e-4);
  EXPECT_NEAR(back.values[1], -20, 7e-4);
  EXPECT_NEAR(back.values[2], 0.25, 3e-5);
  EXPECT_NEAR(back.values[3], 0.75, 8e-6);
}

TEST(MakePose, ValuesThatAreMissingAreNeutralAndSurplusOnesAreNotSent) {
  const Rig rig = TestRig();
  RigPose pose;
  const Pose none = MakePose(rig, 0, pose, ServiceState::kResting, Time{});
  ASSERT_EQ(none.values.size(), 4U);
  EXPECT_NEAR(ValuesOf(none, rig).values[0], 1.5, 2e-4);
  pose.count = 100;
  EXPECT_EQ(MakePose(rig, 0, pose, ServiceState::kResting, Time{}).values.size(), 4U);
}

TEST(MakePose, TheAgeNeverRunsBackwardsAndSaturates) {
  const Rig rig = TestRig();
  RigPose pose = rig.NeutralPose();
  pose.captured = Time(Duration(1000));
  const auto age = [&](Time now) {
    return MakePose(rig, 0, pose, ServiceState::kHolding, now).age_us;
  };
  EXPECT_EQ(age(Time(Duration(999))), 0U);
  EXPECT_EQ(age(Time(Duration(1001))), 1U);
  EXPECT_EQ(age(Time(std::chrono::hours(2))), 0xFFFFFFFFU);
  pose.captured = Time::min();
  EXPECT_EQ(age(Time::max()), 0xFFFFFFFFU);
}

TEST(ValuesOf, APoseOfAnotherSizeNeverReadsBeyondEither) {
  const Rig rig = TestRig();
  Pose message;
  EXPECT_EQ(ValuesOf(message, rig).values[0], 1.5F);
  (void)message.values.try_resize(kMaxChannels);
  EXPECT_EQ(ValuesOf(message, rig).count, 4U);
}

}  // namespace
}  // namespace facewire::wire
