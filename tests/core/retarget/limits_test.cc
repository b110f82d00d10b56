// What every rig is promised: from any face, over any time, no bone and no channel leaves its
// limits.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <random>
#include <string>

#include "core/limit/limiter.h"
#include "core/retarget/retargeter.h"
#include "tests/core/retarget/training_example.h"

namespace facewire::retarget {
namespace {

using std::chrono::hours;
using std::chrono::microseconds;

ShortName Named(std::string_view name) { return TrainingExample::Named(name); }

class LimitsProperty : public testing::TestWithParam<unsigned> {
 protected:
  float Between(float a, float b) { return std::uniform_real_distribution<float>(a, b)(random_); }
  int Count(int a, int b) { return std::uniform_int_distribution<int>(a, b)(random_); }
  bool Chance(int one_in) { return Count(1, one_in) == 1; }

  // As wild as a rig file may be.
  Channel RandomChannel() {
    const float size = std::pow(10.F, Between(-2, 3));
    Channel channel;
    channel.min = Between(-size, size);
    channel.max = Between(channel.min, size);
    channel.neutral = Chance(4) ? channel.min : Between(channel.min, channel.max);
    channel.knee = Chance(4) ? 0 : Between(0, 0.5F);
    channel.max_speed_per_s = Chance(2) ? 0 : size;
    channel.max_acceleration_per_s2 = Chance(2) ? 0 : 10 * size;
    channel.response.gain = Between(-10, 10);
    channel.response.bias = Chance(2) ? 0 : Between(-size, size);
    CurvePoint point{Between(-size, 0), Between(-size, 0)};
    for (int left = Chance(2) ? 0 : Count(2, kMaxCurvePoints); left > 0; --left) {
      EXPECT_TRUE(channel.response.curve.try_push(point));
      point.in += Between(0.01F, 1) * size;
      if (!Chance(3)) point.out += Between(0, 1) * size;
    }
    return channel;
  }
  Rig RandomRig() {
    Rig rig;
    const int bones = Count(1, 12);
    for (std::int16_t b = 0; b < bones; ++b) {
      Bone bone;
      bone.name = Named("b" + std::to_string(b));
      bone.rest_cm = {Between(-9, 9), Between(-9, 9), Between(-9, 9)};
      bone.landmark = static_cast<std::int16_t>(Count(0, kMaxLandmarks - 1));
      EXPECT_TRUE(rig.bones.try_push(bone));
      for (const auto kind : {ChannelKind::kPositionX, ChannelKind::kPositionY,
                              ChannelKind::kPositionZ, ChannelKind::kPitch}) {
        Channel channel = RandomChannel();
        channel.kind = kind;
        channel.bone = b;
        if (kind == ChannelKind::kPitch) {
          EXPECT_TRUE(channel.drives.try_push({Named("head.pitch"), Between(-1e6F, 1e6F)}));
        }
        EXPECT_TRUE(rig.channels.try_push(channel));
      }
    }
    for (const char* signal : {"blink", "open", "mutter", "head.x"}) {
      Channel channel = RandomChannel();
      EXPECT_TRUE(channel.drives.try_push({Named(signal), Between(-100, 100)}));
      EXPECT_TRUE(channel.drives.try_push({Named("blink"), Between(-100, 100)}));
      EXPECT_TRUE(rig.channels.try_push(channel));
    }
    return rig;
  }
  float Wild() {
    constexpr float kWild[] = {std::numeric_limits<float>::quiet_NaN(),
                               std::numeric_limits<float>::infinity(),
                               -std::numeric_limits<float>::infinity(),
                               std::numeric_limits<float>::max(),
                               -1e38F,
                               1e20F,
                               1e-42F};
    return kWild[Count(0, 6)];
  }
  Point3 RandomPoint() { return {Between(-10, 10), Between(-10, 10), Between(-10, 10)}; }
  void Move(FacePose& face) {
    const bool leaps = Chance(5);
    for (Point3& p : face.points_cm) {
      if (leaps) p = RandomPoint();
      p = p + 0.05F * RandomPoint();
      if (Chance(200)) p = {Wild(), Wild(), Wild()};
      if (!IsWithin(p, 1e4F) && Chance(3)) p = RandomPoint();
    }
    if (Chance(10)) face.camera_R_head[static_cast<std::size_t>(Count(0, 8))] = Wild();
    if (Chance(5)) face.camera_R_head = kIdentity3;
    if (Chance(10)) face.camera_t_head_cm.x = Wild();
    if (Chance(10)) face.count = static_cast<std::size_t>(Count(0, kMaxLandmarks));
    face.captured += Chance(10) ? -Duration(hours(Count(-1, 1)))
                                : Duration(microseconds(Count(-100'000, 100'000)));
  }

  std::mt19937 random_{GetParam()};
};

TEST_P(LimitsProperty, NoBoneAndNoChannelEverLeavesThem) {
  ExampleMapping average;
  ExampleMapping personal;
  ASSERT_TRUE(average.Configure({}));
  TrainingExample own;
  own.signals[1] = Named("mutter");
  ASSERT_TRUE(personal.Configure(own));
  std::vector<std::byte> block(Retargeter::RequiredBytes());
  const auto retargeter = std::make_unique<Retargeter>();
  const auto limiter = std::make_unique<limit::Limiter>();
  const auto face = std::make_unique<FacePose>();
  for (int trial = 0; trial < 20; ++trial) {
    const auto rig = std::make_unique<Rig>(RandomRig());
    Arena arena(block);
    ASSERT_TRUE(retargeter->Configure(*rig, &average.mapping, arena, &personal.mapping));
    ASSERT_TRUE(limiter->Configure(*rig));
    face->count = kMaxLandmarks;
    face->captured = Time(hours(100));
    face->camera_R_head = kIdentity3;
    for (Point3& p : face->points_cm) p = RandomPoint();
    const Neutral neutral{face->count, face->points_cm, face->camera_R_head, {}};
    if (!Chance(10)) {
      ASSERT_TRUE(retargeter->SetNeutral(neutral));
    }
    for (int frame = 0; frame < 100; ++frame) {
      Move(*face);
      if (Chance(20)) retargeter->SetBlend(Chance(2) ? Wild() : Between(0, 1));
      const RigPose wish = retargeter->Update(*face);
      const RigPose sent = limiter->Update(wish, face->captured);
      ASSERT_EQ(sent.count, rig->channels.size());
      for (std::size_t i = 0; i < sent.count; ++i) {
        const Channel& channel = rig->channels[i];
        ASSERT_TRUE(std::isfinite(wish.values[i])) << i;
        ASSERT_GE(sent.values[i], channel.min) << i;
        ASSERT_LE(sent.values[i], channel.max) << i;
        if (channel.knee == 0) continue;
        ASSERT_GE(wish.values[i], channel.min) << "a knee alone keeps them, too";
        ASSERT_LE(wish.values[i], channel.max) << i;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, LimitsProperty, testing::Range(0U, 10U));

}  // namespace
}  // namespace facewire::retarget
