#include "tools/facewire/frame_picker.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace facewire::tools {
namespace {

constexpr int kFps = 50;

// A performance of one chin and one brow: each pose is reached in half a second and held for as
// long.
struct Context {
  std::vector<SessionFrame> frames;
  Point3 chin{0, -8, 0}, brow{0, 4, 0};

  void GoTo(Point3 new_chin, Point3 new_brow) {
    const Point3 from_chin = chin;
    const Point3 from_brow = brow;
    for (int i = 1; i <= kFps; ++i) {
      const float part = std::min(1.0F, static_cast<float>(i) / (kFps / 2.0F));
      chin = from_chin + part * (new_chin - from_chin);
      brow = from_brow + part * (new_brow - from_brow);
      const auto number = static_cast<std::uint64_t>(frames.size());
      frames.push_back(
          {number, static_cast<std::int64_t>(number) * 1'000'000 / kFps, {chin, brow}});
    }
  }
  void Rest() { GoTo({0, -8, 0}, {0, 4, 0}); }
};

Context Performance() {
  Context c;
  c.Rest();
  c.GoTo({0, -10, 0}, {0, 4, 0});  // open
  c.Rest();
  c.GoTo({0, -9, 0}, {0, 4, 0});  // half open
  c.Rest();
  c.GoTo({0, -8, 0}, {0, 5, 0});  // brow
  c.Rest();
  c.GoTo({0, -10, 0}, {0, 5, 0});  // both
  c.Rest();
  return c;
}

// Both motions at once go furthest; then each alone is missing. Half a motion is not.
TEST(FramePicker, PicksTheNeutralAndEachExpressionOnce) {
  const Context c = Performance();
  const PickedFrames picked = PickFrames(c.frames, {});
  ASSERT_EQ(picked.frames.size(), 4U);
  std::vector<std::vector<Point3>> poses;
  for (const PickedFrame& pick : picked.frames) poses.push_back(c.frames[pick.index].points_cm);
  using Pose = std::vector<Point3>;
  EXPECT_EQ(poses[1], (Pose{{0, -10, 0}, {0, 5, 0}}));
  EXPECT_THAT(poses,
              testing::IsSupersetOf({Pose{{0, -10, 0}, {0, 4, 0}}, Pose{{0, -8, 0}, {0, 5, 0}}}));
  EXPECT_EQ(c.frames[picked.frames[0].index].points_cm[0], (Point3{0, -8, 0}));
  EXPECT_EQ(picked.frames[0].explained, 0);
  EXPECT_NEAR(picked.frames.back().explained, 1, 1e-6);
  EXPECT_NEAR(picked.furthest_cm, 0, 1e-3);
}

TEST(FramePicker, PrefersHeldPosesToBlurs) {
  const Context c = Performance();
  for (const PickedFrame& pick : PickFrames(c.frames, {}).frames) {
    if (pick.index < kFps) continue;  // the first second is all rest
    EXPECT_GE(pick.index % kFps, 24U) << "on the way to a pose";
  }
}

TEST(FramePicker, SaysWhichMarkersBringAFrame) {
  const Context c = Performance();
  const PickedFrames picked = PickFrames(c.frames, {.most = 2, .tolerance = 0, .neutral = {}});
  ASSERT_EQ(picked.frames.size(), 2U);
  EXPECT_EQ(picked.frames[1].moved.front(), 0U);  // the chin goes twice as far
  // What is left of the chin alone, (2, 0), beside a blend of both, (2, 1): 2 / sqrt(5) cm.
  EXPECT_NEAR(picked.furthest_cm, 2 / std::sqrt(5.0) / std::sqrt(2.0), 1e-3);
}

TEST(FramePicker, IgnoresASingleBadFrame) {
  Context c = Performance();
  c.frames[70].points_cm[0] = {30, 30, 30};
  for (const PickedFrame& pick : PickFrames(c.frames, {}).frames) EXPECT_NE(pick.index, 70U);
}

TEST(FramePicker, LeavesFramesWithGapsOut) {
  Context c = Performance();
  for (std::size_t i = 300; i < c.frames.size(); ++i) c.frames[i].points_cm[1] = {NAN, NAN, NAN};
  c.frames[10].points_cm.clear();
  for (const PickedFrame& pick : PickFrames(c.frames, {}).frames) EXPECT_LT(pick.index, 300U);
}

TEST(FramePicker, TakesTheNeutralAndTheCountThatAreAskedFor) {
  const Context c = Performance();
  const PickedFrames picked = PickFrames(c.frames, {.most = 5, .tolerance = 0, .neutral = 240});
  EXPECT_LE(picked.frames.size(), 5U);
  EXPECT_EQ(picked.frames[0].index, 240U);
}

TEST(FramePicker, FindsTheFaceAtRestThoughATakeBeginsAndEndsElsewhere) {
  Context c;
  c.GoTo({0, -10, 0}, {0, 5, 0});
  c.Rest();
  c.Rest();
  c.GoTo({0, -8, 0}, {0, 5, 0});
  c.GoTo({1, -8, 0}, {0, 4, 0});
  const PickedFrames picked = PickFrames(c.frames, {});
  EXPECT_EQ(c.frames[picked.frames[0].index].points_cm[1], (Point3{0, 4, 0}));
  EXPECT_EQ(c.frames[picked.frames[0].index].points_cm[0], (Point3{0, -8, 0}));
}

TEST(FramePicker, IsContentWithStillsAndWithASingleFrame) {
  std::vector<SessionFrame> stills;
  for (std::uint64_t i = 0; i < 4; ++i)
    stills.push_back(
        {i, static_cast<std::int64_t>(i) * 2'000'000, {{static_cast<float>(i), 0, 0}}});
  EXPECT_GE(PickFrames(stills, {}).frames.size(), 2U);
  stills.resize(1);
  const PickedFrames one = PickFrames(stills, {});
  EXPECT_EQ(one.frames.size(), 1U);
  EXPECT_EQ(one.frames[0].explained, 1);
}

}  // namespace
}  // namespace facewire::tools
