#include "core/retarget/neutral_capture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <vector>

namespace facewire::retarget {
namespace {

struct Context {
  NeutralCaptureConfig config;
  std::vector<std::byte> block = std::vector<std::byte>(NeutralCapture::RequiredBytes());
  NeutralCapture capture;

  explicit Context(NeutralCaptureConfig c = {}) : config(c) {
    Arena arena(block);
    EXPECT_TRUE(capture.Configure(config, arena));
  }
};

// 478 points, point i at (i, 1, 0), seen at frame `frame` of `fps`.
std::unique_ptr<FacePose> Face(int frame, double fps = 30) {
  auto face = std::make_unique<FacePose>();
  face->captured = Time(Duration(static_cast<std::int64_t>(frame * 1e6 / fps)));
  face->count = kMaxLandmarks;
  for (std::size_t i = 0; i < face->count; ++i) face->points_cm[i] = {static_cast<float>(i), 1, 0};
  face->camera_t_head_cm = {0, 0, -50};
  return face;
}

TEST(NeutralCapture, IsReadyAfterItsDurationAndNotBefore) {
  Context c;
  for (int i = 0; i < 60; ++i) {
    c.capture.Add(*Face(i));
    EXPECT_EQ(c.capture.Finish().error(), Errc::kNotReady) << i;
  }
  EXPECT_LT(c.capture.progress(), 1);
  c.capture.Add(*Face(60));
  const auto neutral = c.capture.Finish();
  ASSERT_TRUE(neutral);
  EXPECT_EQ(neutral->count, kMaxLandmarks);
  EXPECT_EQ(neutral->points_cm[7], (Point3{7, 1, 0}));
  EXPECT_EQ(neutral->camera_t_head_cm, (Point3{0, 0, -50}));
}

TEST(NeutralCapture, BlinksInTheWindowDoNotMatter) {
  Context c;
  for (int i = 0; i <= 60; ++i) {
    auto face = Face(i);
    face->points_cm[386].y += 0.01F * static_cast<float>(i % 3 - 1);
    if (i >= 20 && i < 32) face->points_cm[386].y -= 1;  // closed for 0.4 s
    c.capture.Add(*face);
  }
  const auto neutral = c.capture.Finish();
  ASSERT_TRUE(neutral);
  EXPECT_NEAR(neutral->points_cm[386].y, 1, 0.011F);
}

TEST(NeutralCapture, AWordSpokenInTheWindowDoesNotMatter) {
  Context c;
  for (int i = 0; i <= 60; ++i) {
    auto face = Face(i);
    if (i > 32)
      for (std::size_t p = 14; p < 90; ++p) face->points_cm[p].y -= 2;
    c.capture.Add(*face);
  }
  const auto neutral = c.capture.Finish();
  ASSERT_TRUE(neutral);
  EXPECT_EQ(neutral->points_cm[14].y, 1);
}

TEST(NeutralCapture, AMouthThatStandsOpenIsNoFaceAtRest) {
  Context c;
  for (int i = 0; i <= 60; ++i) {
    auto face = Face(i);
    face->points_cm[78] = {-2, 0, 0};
    face->points_cm[308] = {2, 0, 0};
    face->points_cm[13] = {0, 0.5F, 0};
    face->points_cm[14] = {0, -0.5F, 0};
    c.capture.Add(*face);
  }
  EXPECT_EQ(c.capture.Finish().error(), Errc::kRejected);
}

TEST(NeutralCapture, AFaceThatKeepsMovingIsRefused) {
  Context c;
  for (int i = 0; i <= 60; ++i) {
    auto face = Face(i);
    for (std::size_t p = 0; p < 100; ++p)
      face->points_cm[p].y += 0.6F * std::sin(static_cast<float>(i) / 3);
    c.capture.Add(*face);
  }
  EXPECT_EQ(c.capture.Finish().error(), Errc::kRejected);
  c.capture.Reset();
  EXPECT_EQ(c.capture.Finish().error(), Errc::kNotReady);
}

TEST(NeutralCapture, AHeadThatKeepsTurningIsRefused) {
  Context c;
  for (int i = 0; i <= 60; ++i) {
    auto face = Face(i);
    const float yaw = 0.6F * std::sin(static_cast<float>(i) / 8);
    face->camera_R_head = {std::cos(yaw),  0, std::sin(yaw), 0, 1, 0,
                           -std::sin(yaw), 0, std::cos(yaw)};
    c.capture.Add(*face);
  }
  EXPECT_EQ(c.capture.Finish().error(), Errc::kRejected);
}

TEST(NeutralCapture, AHighFrameRateThatOverflowsTheMemoryIsThinnedOut) {
  Context c;
  for (int i = 0; i <= 1000; ++i) {
    auto face = Face(i, 500);
    face->points_cm[3].x = i < 490 ? 0.0F : 0.1F;  // 0.1 for the longer part of the window
    c.capture.Add(*face);
  }
  const auto neutral = c.capture.Finish();
  ASSERT_TRUE(neutral);
  EXPECT_EQ(neutral->points_cm[3].x, 0.1F);
}

TEST(NeutralCapture, StartsOverWhenTheTrackerChanges) {
  Context c;
  for (int i = 0; i < 60; ++i) c.capture.Add(*Face(i));
  auto mesh = Face(61);
  mesh->count = kMeshLandmarks;
  c.capture.Add(*mesh);
  EXPECT_LT(c.capture.progress(), 0.1F);
}

TEST(NeutralCapture, FacesThatAreNotFiniteAreNotCounted) {
  Context c;
  for (int i = 0; i <= 60; ++i) {
    auto face = Face(i);
    face->points_cm[5].z = std::numeric_limits<float>::quiet_NaN();
    c.capture.Add(*face);
  }
  EXPECT_EQ(c.capture.Finish().error(), Errc::kNotReady);
}

TEST(NeutralCapture, RefusesSettingsThatCannotWork) {
  std::vector<std::byte> block(NeutralCapture::RequiredBytes());
  Arena arena(block);
  NeutralCapture capture;
  EXPECT_EQ(capture.Configure({.min_frames = 0}, arena).error(), Errc::kOutOfRange);
  EXPECT_EQ(capture.Configure({.min_frames = 100}, arena).error(), Errc::kOutOfRange);
  EXPECT_EQ(capture.Configure({.max_stray_cm = 0}, arena).error(), Errc::kOutOfRange);
  Arena small(std::span<std::byte>(block).first(100));
  EXPECT_EQ(capture.Configure({}, small).error(), Errc::kFull);
}

}  // namespace
}  // namespace facewire::retarget
