#include "core/limit/limiter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <random>
#include <vector>

#include "tests/support/allocation_counter.h"

namespace facewire::limit {
namespace {

using std::chrono::hours;
using std::chrono::microseconds;
using std::chrono::milliseconds;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

facewire::Channel MakeChannel(float min, float neutral, float max, float speed = 0,
                              float acceleration = 0) {
  facewire::Channel channel;
  channel.min = min;
  channel.neutral = neutral;
  channel.max = max;
  channel.max_speed_per_s = speed;
  channel.max_acceleration_per_s2 = acceleration;
  return channel;
}

// A rig with one channel, and targets for it at given times.
class LimiterTest : public testing::Test {
 protected:
  Result<> Configure(const facewire::Channel& channel) {
    rig_->channels.clear();
    EXPECT_TRUE(rig_->channels.try_push(channel));
    return limiter_->Configure(*rig_);
  }
  float Call(float target, Duration at) {
    RigPose pose{.count = 1};
    pose.values[0] = target;
    const RigPose out = limiter_->Update(pose, Time(at));
    EXPECT_EQ(out.count, 1U);
    return out.values[0];
  }

  std::unique_ptr<Rig> rig_ = std::make_unique<Rig>();
  std::unique_ptr<Limiter> limiter_ = std::make_unique<Limiter>();
};

TEST_F(LimiterTest, AValueInsideTheLimitsPassesUnchanged) {
  ASSERT_TRUE(Configure(MakeChannel(-1, 0, 2)));
  EXPECT_EQ(Call(1.25F, milliseconds(0)), 1.25F);
  EXPECT_EQ(Call(-1, milliseconds(33)), -1.F);
  EXPECT_EQ(Call(2, milliseconds(66)), 2.F);
}

TEST_F(LimiterTest, NoInputPassesTheLimits) {
  ASSERT_TRUE(Configure(MakeChannel(-1, 0, 2)));
  EXPECT_EQ(Call(2.0000002F, milliseconds(0)), 2.F);
  EXPECT_EQ(Call(-3, milliseconds(0)), -1.F);
  EXPECT_EQ(Call(kInfinity, milliseconds(0)), 2.F);
  EXPECT_EQ(Call(-kInfinity, milliseconds(0)), -1.F);
  EXPECT_EQ(Call(1e38F, milliseconds(0)), 2.F);
  EXPECT_EQ(Call(-std::numeric_limits<float>::max(), milliseconds(0)), -1.F);
  EXPECT_EQ(Call(1e-42F, milliseconds(0)), 1e-42F);  // denormal
}

TEST_F(LimiterTest, NanKeepsTheLastTarget) {
  ASSERT_TRUE(Configure(MakeChannel(-1, 0.5F, 2)));
  EXPECT_EQ(Call(kNan, milliseconds(0)), 0.5F) << "no target yet: neutral";
  EXPECT_EQ(Call(1.5F, milliseconds(33)), 1.5F);
  EXPECT_EQ(Call(kNan, milliseconds(66)), 1.5F);
}

TEST_F(LimiterTest, NanLetsAMovingChannelArriveWhereItWasGoing) {
  ASSERT_TRUE(Configure(MakeChannel(0, 0, 2, 1)));
  Call(1, milliseconds(0));
  EXPECT_NEAR(Call(1, milliseconds(100)), 0.1F, 1e-6);
  EXPECT_NEAR(Call(kNan, milliseconds(200)), 0.2F, 1e-6);
  for (int ms = 300; ms < 1200; ms += 100) Call(kNan, milliseconds(ms));
  EXPECT_EQ(Call(kNan, milliseconds(1200)), 1.F);
}

TEST_F(LimiterTest, AMissingValueIsLikeNan) {
  ASSERT_TRUE(Configure(MakeChannel(-1, 0.5F, 2)));
  Call(1.5F, milliseconds(0));
  const RigPose out = limiter_->Update(RigPose{.seq = 9, .captured = Time(milliseconds(20))},
                                       Time(milliseconds(33)));
  EXPECT_EQ(out.count, 1U);
  EXPECT_EQ(out.values[0], 1.5F);
  EXPECT_EQ(out.seq, 9U);
  EXPECT_EQ(out.captured, Time(milliseconds(20)));
}

TEST_F(LimiterTest, TheFirstCallOnlyStartsTheTime) {
  ASSERT_TRUE(Configure(MakeChannel(0, 0, 2, 1, 10)));
  EXPECT_EQ(Call(2, hours(5)), 0.F);
  EXPECT_GT(Call(2, hours(5) + milliseconds(50)), 0.F);
}

TEST_F(LimiterTest, WithoutSpeedLimitsTheFirstCallIsAtItsTarget) {
  ASSERT_TRUE(Configure(MakeChannel(0, 0, 2)));
  EXPECT_EQ(Call(1.75F, hours(5)), 1.75F);
}

TEST_F(LimiterTest, ALongSilenceDoesNotMakeTheMotionLeap) {
  ASSERT_TRUE(Configure(MakeChannel(0, 0, 100, 10)));
  Call(100, milliseconds(0));
  EXPECT_NEAR(Call(100, milliseconds(200)), 2, 1e-6);
  EXPECT_NEAR(Call(100, hours(1)), 4, 1e-6) << "as if kMaxStep had passed";
  EXPECT_NEAR(Call(100, hours(1) + milliseconds(100)), 5, 1e-6);
}

TEST_F(LimiterTest, AfterALongSilenceItStartsFromRest) {
  ASSERT_TRUE(Configure(MakeChannel(0, 0, 100, 0, 10)));
  Call(100, milliseconds(0));
  for (int ms = 100; ms <= 1000; ms += 100) Call(100, milliseconds(ms));
  const float before = Call(100, milliseconds(1000));
  EXPECT_NEAR(before, 5, 1e-5);
  EXPECT_NEAR(Call(100, milliseconds(5000)) - before, 10 * 0.2 * 0.2 / 2, 1e-5);
}

TEST_F(LimiterTest, TimeThatStandsStillMovesNothing) {
  ASSERT_TRUE(Configure(MakeChannel(0, 0, 100, 10, 100)));
  Call(100, milliseconds(0));
  const float moving = Call(100, milliseconds(100));
  EXPECT_EQ(Call(100, milliseconds(100)), moving);
  EXPECT_EQ(Call(0, milliseconds(100)), moving);
}

TEST_F(LimiterTest, ALateTimestampMovesNothingAndIsNotCountedTwice) {
  ASSERT_TRUE(Configure(MakeChannel(0, 0, 100, 10)));
  Call(100, milliseconds(0));
  EXPECT_NEAR(Call(100, milliseconds(100)), 1, 1e-6);
  EXPECT_NEAR(Call(100, milliseconds(50)), 1, 1e-6);
  EXPECT_NEAR(Call(100, milliseconds(150)), 1.5, 1e-6) << "50 ms after the latest, not 100";
}

TEST_F(LimiterTest, AnotherClockDoesNotStopTheMotionForever) {
  ASSERT_TRUE(Configure(MakeChannel(0, 0, 100, 10)));
  Call(100, hours(3));
  EXPECT_NEAR(Call(100, hours(3) + milliseconds(100)), 1, 1e-6);
  EXPECT_NEAR(Call(100, milliseconds(7)), 1, 1e-6);
  EXPECT_NEAR(Call(100, milliseconds(107)), 2, 1e-6);
}

TEST_F(LimiterTest, TheExtremesOfTimeDoNotOverflow) {
  ASSERT_TRUE(Configure(MakeChannel(0, 0, 100, 10, 100)));
  Call(100, Duration::max());
  EXPECT_EQ(Call(100, Duration::min()), 0.F);
  EXPECT_NEAR(Call(100, Duration::max()), 1.5, 1e-6) << "one step of kMaxStep from rest";
}

TEST_F(LimiterTest, ResetContinuesFromAGivenPoseAtRest) {
  ASSERT_TRUE(Configure(MakeChannel(0, 1, 10, 10, 100)));
  RigPose pose{.count = 1};
  pose.values[0] = 8;
  limiter_->Reset(pose);
  EXPECT_EQ(Call(kNan, milliseconds(0)), 8.F);
  EXPECT_EQ(Call(8, milliseconds(100)), 8.F);
  EXPECT_LT(Call(0, milliseconds(200)), 8.F);
}

TEST_F(LimiterTest, ResetClampsAndTakesNeutralForWhatIsMissing) {
  ASSERT_TRUE(Configure(MakeChannel(0, 1, 10, 10, 100)));
  RigPose pose{.count = 1};
  pose.values[0] = kInfinity;
  limiter_->Reset(pose);
  EXPECT_EQ(Call(kNan, milliseconds(0)), 10.F);
  pose.values[0] = kNan;
  limiter_->Reset(pose);
  EXPECT_EQ(Call(kNan, milliseconds(0)), 1.F);
  pose.count = 0;
  limiter_->Reset(pose);
  EXPECT_EQ(Call(kNan, milliseconds(0)), 1.F);
}

TEST_F(LimiterTest, BeforeConfigureThereAreNoValues) {
  EXPECT_EQ(limiter_->Update(RigPose{.count = kMaxChannels}, Time{}).count, 0U);
}

TEST_F(LimiterTest, RefusesRigsWhoseLimitsAreNoLimits) {
  for (const facewire::Channel& bad :
       {MakeChannel(1, 1, 0), MakeChannel(0, 2, 1), MakeChannel(0, -1, 1), MakeChannel(kNan, 0, 1),
        MakeChannel(0, kNan, 1), MakeChannel(0, 0, kNan), MakeChannel(-kInfinity, 0, 1),
        MakeChannel(0, 0, kInfinity), MakeChannel(0, 0, 1, -1), MakeChannel(0, 0, 1, kNan),
        MakeChannel(0, 0, 1, kInfinity), MakeChannel(0, 0, 1, 0, -1), MakeChannel(0, 0, 1, 0, kNan),
        MakeChannel(0, 0, 1, 0, kInfinity)}) {
    EXPECT_EQ(Configure(bad).error(), Errc::kOutOfRange);
  }
}

TEST_F(LimiterTest, ARefusedRigLeavesTheOldOneInPlace) {
  ASSERT_TRUE(Configure(MakeChannel(0, 0.5F, 1)));
  EXPECT_FALSE(Configure(MakeChannel(1, 1, 0)));
  EXPECT_EQ(Call(7, milliseconds(0)), 1.F);
}

TEST_F(LimiterTest, AChannelThatMayNotMoveDoesNot) {
  ASSERT_TRUE(Configure(MakeChannel(0.5F, 0.5F, 0.5F, 1, 1)));
  EXPECT_EQ(Call(1, milliseconds(0)), 0.5F);
  EXPECT_EQ(Call(kInfinity, milliseconds(100)), 0.5F);
}

TEST_F(LimiterTest, AbsurdLimitsAreKeptAsWell) {
  constexpr float kHuge = std::numeric_limits<float>::max();
  constexpr float kTiny = std::numeric_limits<float>::denorm_min();
  for (float range : {kHuge, 1.F, kTiny}) {
    for (float speed : {0.F, kTiny, 1.F, kHuge}) {
      for (float acceleration : {0.F, kTiny, 1.F, kHuge}) {
        ASSERT_TRUE(Configure(MakeChannel(-range, 0, range, speed, acceleration)));
        for (int i = 0; i < 50; ++i) {
          const float value = Call(i % 7 < 4 ? kInfinity : -kInfinity, milliseconds(33 * i));
          ASSERT_GE(value, -range);
          ASSERT_LE(value, range);
        }
      }
    }
  }
}

// What holds for every rig, every target and every sequence of times.
class LimiterProperty : public testing::TestWithParam<unsigned> {
 protected:
  float Between(float a, float b) { return std::uniform_real_distribution<float>(a, b)(random_); }
  bool Chance(int one_in) { return std::uniform_int_distribution<int>(1, one_in)(random_) == 1; }
  float Scale() { return std::pow(10.F, Between(-3, 4)); }

  facewire::Channel RandomChannel() {
    const float size = Scale();
    const float min = Between(-size, size);
    const float max = Chance(20) ? min : Between(min, size);
    return MakeChannel(min, Between(min, max), max, Chance(4) ? 0 : size * Scale() / 10,
                       Chance(4) ? 0 : size * Scale());
  }
  float RandomTarget(const facewire::Channel& c) {
    constexpr float kWild[] = {kNan, kInfinity, -kInfinity, 1e38F, -1e38F, 1e-42F, 0, -0.F};
    if (Chance(10)) return kWild[std::uniform_int_distribution<int>(0, 7)(random_)];
    return Between(c.min - (c.max - c.min), c.max + (c.max - c.min));
  }
  Duration RandomStep() {
    if (Chance(50)) return -microseconds(std::uniform_int_distribution<int>(1, 100000)(random_));
    if (Chance(20)) return microseconds(0);
    if (Chance(20)) return microseconds(std::uniform_int_distribution<int>(1, 100)(random_));
    return microseconds(std::uniform_int_distribution<int>(5000, 200000)(random_));
  }

  std::mt19937 random_{GetParam()};
};

TEST_P(LimiterProperty, PositionSpeedAndAccelerationHoldForEveryInput) {
  auto rig = std::make_unique<Rig>();
  for (std::size_t i = 0; i < kMaxChannels; ++i) {
    ASSERT_TRUE(rig->channels.try_push(RandomChannel()));
  }
  auto limiter = std::make_unique<Limiter>();
  ASSERT_TRUE(limiter->Configure(*rig));

  RigPose target{.count = kMaxChannels};
  Time now(hours(1));
  Time latest = now;  // at the last step that counted
  double previous_s = 0;
  std::vector<double> previous_speed(kMaxChannels, 0);
  RigPose previous = limiter->Update(rig->NeutralPose(), now);
  for (int step = 0; step < 400; ++step) {
    now += RandomStep();
    if (Chance(5)) {
      for (std::size_t i = 0; i < kMaxChannels; ++i) {
        target.values[i] = RandomTarget(rig->channels[i]);
      }
    }
    const RigPose out = limiter->Update(target, now);
    const double dt_s = std::chrono::duration<double>(now - latest).count();
    for (std::size_t i = 0; i < kMaxChannels; ++i) {
      const facewire::Channel& c = rig->channels[i];
      ASSERT_GE(out.values[i], c.min);
      ASSERT_LE(out.values[i], c.max);
      if (c.max_speed_per_s == 0 && c.max_acceleration_per_s2 == 0) continue;
      const double moved = double{out.values[i]} - previous.values[i];
      if (dt_s <= 0) {
        ASSERT_EQ(moved, 0);
        continue;
      }
      // Positions leave as floats: each is off by half a unit of its last place.
      const double rounding = std::max(std::abs(c.min), std::abs(c.max)) * 0x1p-23 / dt_s;
      const double speed = moved / dt_s;
      if (c.max_speed_per_s > 0) {
        ASSERT_LE(std::abs(speed), c.max_speed_per_s * (1 + 1e-6) + rounding) << "channel " << i;
      }
      // The mean speed of a step is the speed somewhere within it, and the middles of two steps lie
      // half of both apart.
      if (c.max_acceleration_per_s2 > 0) {
        const double before =
            std::max(std::abs(c.min), std::abs(c.max)) * 0x1p-23 / std::max(previous_s, 1e-6);
        const double between_s = (dt_s + previous_s) / 2;
        ASSERT_LE(std::abs(speed - previous_speed[i]),
                  c.max_acceleration_per_s2 * between_s * (1 + 1e-6) + rounding + before)
            << "channel " << i << " step " << step;
      }
      previous_speed[i] = speed;
    }
    if (dt_s > 0) {
      latest = now;
      previous_s = dt_s;
    }
    previous = out;
  }
}

TEST_P(LimiterProperty, SettlesExactlyAndStaysWithoutSwinging) {
  for (int trial = 0; trial < 50; ++trial) {
    facewire::Channel c = RandomChannel();
    auto rig = std::make_unique<Rig>();
    ASSERT_TRUE(rig->channels.try_push(c));
    auto limiter = std::make_unique<Limiter>();
    ASSERT_TRUE(limiter->Configure(*rig));
    RigPose target{.count = 1};
    target.values[0] = Between(c.min, c.max);
    // Long enough for the whole range: there and back under each limit.
    const double range = double{c.max} - c.min;
    double needed_s = 1;
    if (c.max_speed_per_s > 0) needed_s += range / c.max_speed_per_s;
    if (c.max_acceleration_per_s2 > 0) needed_s += 2 * std::sqrt(range / c.max_acceleration_per_s2);
    if (needed_s > 1000) continue;  // would take too many steps; other trials cover it

    const float goal = target.values[0];
    float last = limiter->Update(target, Time{}).values[0];
    const bool up = last <= goal;
    double s = 0;
    Time now{};
    while (s < needed_s) {
      const Duration step = microseconds(std::uniform_int_distribution<int>(1000, 190000)(random_));
      now += step;
      s += std::chrono::duration<double>(step).count();
      const float value = limiter->Update(target, now).values[0];
      ASSERT_TRUE(up ? value >= last && value <= goal : value <= last && value >= goal)
          << "from rest it goes straight there";
      last = value;
    }
    ASSERT_EQ(last, goal);
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, LimiterProperty, testing::Range(0U, 12U));

TEST(LimiterMemory, UpdateAllocatesNothing) {
  if (!test::AllocationCounter::kAvailable) GTEST_SKIP() << test::AllocationCounter::kWhyNot;
  auto rig = std::make_unique<Rig>();
  while (rig->channels.try_push(MakeChannel(0, 0, 1, 1, 10))) {
  }
  auto limiter = std::make_unique<Limiter>();
  ASSERT_TRUE(limiter->Configure(*rig));
  RigPose target{.count = kMaxChannels};
  target.values.fill(1);
  test::AllocationCounter counter;
  counter.Arm();
  for (int i = 0; i < 100; ++i) limiter->Update(target, Time(milliseconds(33 * i)));
  counter.Disarm();
  EXPECT_EQ(counter.allocations(), 0U);
  EXPECT_EQ(counter.frees(), 0U);
}

}  // namespace
}  // namespace facewire::limit
