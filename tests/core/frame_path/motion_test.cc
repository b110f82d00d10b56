#include "core/frame_path/motion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace facewire {
namespace {

using state::Sight;
using std::chrono::milliseconds;

// Two channels: one without soft limits, one with; a tick every 20 ms.
class Context {
 public:
  Context() { EXPECT_TRUE(motion.Configure(Rig2(), States(), now)); }

  static Rig Rig2(float max = 20) {
    Rig rig;
    Channel jaw;
    jaw.name = *ShortName::From("jaw.pitch");
    jaw.kind = ChannelKind::kPitch;
    jaw.neutral = 1;
    jaw.min = -5;
    jaw.max = max;
    EXPECT_TRUE(rig.channels.try_push(jaw));
    Channel neck = jaw;
    neck.name = *ShortName::From("neck.yaw");
    neck.kind = ChannelKind::kYaw;
    neck.neutral = 0;
    neck.max_speed_per_s = 100;
    neck.max_acceleration_per_s2 = 2000;
    EXPECT_TRUE(rig.channels.try_push(neck));
    return rig;
  }
  static state::StateConfig States() {
    state::StateConfig states;
    states.start_ramp = milliseconds(200);
    states.acquire = milliseconds(200);
    states.hold = milliseconds(200);
    states.ease = milliseconds(400);
    return states;
  }
  MotionOutput Call(Sight sight, bool stop = false, bool release = false) {
    RigPose wish;
    wish.seq = ++seq;
    wish.captured = now;
    wish.count = 2;
    wish.values[0] = jaw;
    wish.values[1] = neck;
    const MotionOutput before = out;
    out = motion.Update({.now = now, .sight = sight, .stop = stop, .release = release}, wish);
    largest_jump = std::max(largest_jump, std::abs(out.pose.values[0] - before.pose.values[0]));
    now += milliseconds(20);
    return out;
  }
  void For(milliseconds time, Sight sight) {
    for (const Time end = now + time; now < end;) Call(sight);
  }

  Motion motion;
  Time now{milliseconds(1000)};
  std::uint64_t seq = 0;
  float jaw = 15;
  float neck = 10;
  MotionOutput out{.pose = Rig2().NeutralPose()};
  float largest_jump = 0;
};

TEST(Motion, StampsEveryPoseAsTheWish) {
  Context c;
  const MotionOutput out = c.Call(Sight::kNoFace);
  EXPECT_EQ(out.pose.seq, 1U);
  EXPECT_EQ(out.pose.captured, Time{milliseconds(1000)});
  EXPECT_EQ(out.pose.count, 2U);
}

TEST(Motion, NeverJumpsThroughALifeOfStates) {
  Context c;
  c.For(milliseconds(500), Sight::kNoFace);
  c.For(milliseconds(600), Sight::kFace);
  EXPECT_FLOAT_EQ(c.out.pose.values[0], 15);
  EXPECT_NEAR(c.out.pose.values[1], 10, 1e-3);
  c.For(milliseconds(300), Sight::kNoFace);  // holding, then on the way to neutral
  c.jaw = -4;
  c.For(milliseconds(600), Sight::kFace);
  EXPECT_FLOAT_EQ(c.out.pose.values[0], -4);
  c.For(milliseconds(2000), Sight::kNoFace);
  EXPECT_FLOAT_EQ(c.out.pose.values[0], 1);
  // 19 units in 200 ms, smoothly: the fastest tick of 20 ms makes 15 % of it.
  EXPECT_LT(c.largest_jump, 3.2F);
}

TEST(Motion, HoldsWhatWasFollowedLast) {
  Context c;
  c.For(milliseconds(500), Sight::kNoFace);
  c.For(milliseconds(600), Sight::kFace);
  c.jaw = 3;  // seen by nobody
  c.For(milliseconds(150), Sight::kRejected);
  EXPECT_EQ(c.out.state, ServiceState::kHolding);
  EXPECT_FLOAT_EQ(c.out.pose.values[0], 15);
}

TEST(Motion, FreezesOnAStopInMidMotionAndLeavesByARamp) {
  Context c;
  c.For(milliseconds(500), Sight::kNoFace);
  c.For(milliseconds(100), Sight::kFace);
  const MotionOutput before = c.out;
  EXPECT_GT(before.pose.values[1], 0);
  for (int i = 0; i < 20; ++i) {
    const MotionOutput out = c.Call(Sight::kFace, true);
    EXPECT_EQ(out.state, ServiceState::kStopped);
    EXPECT_FALSE(out.torque);
    EXPECT_EQ(out.pose.values[0], before.pose.values[0]) << "not even a braking distance";
    EXPECT_EQ(out.pose.values[1], before.pose.values[1]);
  }
  c.largest_jump = 0;
  c.Call(Sight::kFace, false, true);
  EXPECT_EQ(c.out.state, ServiceState::kStarting);
  c.For(milliseconds(200), Sight::kNoFace);
  EXPECT_FLOAT_EQ(c.out.pose.values[0], 1);
  EXPECT_LT(c.largest_jump, 3.2F);
}

TEST(Motion, KeepsWhatIsNoNumberOutOfEveryBlend) {
  Context c;
  c.For(milliseconds(500), Sight::kNoFace);
  c.For(milliseconds(400), Sight::kFace);
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(),
                          std::numeric_limits<float>::infinity(), 1e38F, -1e38F}) {
    c.jaw = c.neck = bad;
    c.For(milliseconds(100), Sight::kFace);
    c.Call(Sight::kNoFace);  // a blend begins and ends with it
    c.For(milliseconds(100), Sight::kFace);
    for (int i = 0; i < 2; ++i) {
      EXPECT_GE(c.out.pose.values[i], -5);
      EXPECT_LE(c.out.pose.values[i], 20);
    }
  }
  c.jaw = 7;
  c.neck = 4;
  c.For(milliseconds(1000), Sight::kFace);
  EXPECT_FLOAT_EQ(c.out.pose.values[0], 7);
  EXPECT_NEAR(c.out.pose.values[1], 4, 1e-3);
}

TEST(Motion, CarriesChannelsOfTheSameNameIntoAnotherRig) {
  Context c;
  c.For(milliseconds(500), Sight::kNoFace);
  c.For(milliseconds(600), Sight::kFace);
  Rig other = Context::Rig2(10);
  Channel fresh;
  fresh.name = *ShortName::From("jawOpen");
  ASSERT_TRUE(other.channels.try_push(fresh));
  ASSERT_TRUE(c.motion.Configure(other, Context::States(), c.now));
  const MotionOutput out = c.Call(Sight::kFace);
  EXPECT_EQ(out.state, ServiceState::kStarting);
  EXPECT_EQ(out.pose.count, 3U);
  EXPECT_FLOAT_EQ(out.pose.values[0], 10) << "within the new limit";
  EXPECT_NEAR(out.pose.values[1], 10, 1e-3) << "where it was";
  EXPECT_FLOAT_EQ(out.pose.values[2], 0) << "neutral";
}

TEST(Motion, GoesOnAsItWasWhenARigIsRefused) {
  Context c;
  c.For(milliseconds(500), Sight::kNoFace);
  c.For(milliseconds(600), Sight::kFace);
  Rig broken = Context::Rig2();
  broken.channels[0].min = 100;
  const Result<> refused = c.motion.Configure(broken, Context::States(), c.now);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error(), Errc::kOutOfRange);
  EXPECT_EQ(c.Call(Sight::kFace).state, ServiceState::kTracking);
  EXPECT_FLOAT_EQ(c.out.pose.values[0], 15);
}

}  // namespace
}  // namespace facewire
