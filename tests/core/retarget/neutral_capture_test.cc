#include "core/retarget/neutral_capture.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
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

// A face of which lids, lips and head are as the test says, otherwise the one above.
std::unique_ptr<FacePose> Performer(int frame, float lids, float lips = 0.1F, float yaw_deg = 0) {
  auto face = Face(frame);
  for (const auto& [outer, inner, upper, lower] :
       {std::array{33, 133, 159, 145}, std::array{263, 362, 386, 374}}) {
    face->points_cm[outer] = {0, 0, 0};
    face->points_cm[inner] = {3, 0, 0};
    face->points_cm[upper] = {1.5F, 3 * lids, 0};
    face->points_cm[lower] = {1.5F, 0, 0};
  }
  face->points_cm[78] = {-2, 0, 0};
  face->points_cm[308] = {2, 0, 0};
  face->points_cm[13] = {0, 0, 0};
  face->points_cm[14] = {0, -4 * lips, 0};
  const float yaw = yaw_deg * std::numbers::pi_v<float> / 180;
  face->camera_R_head = {std::cos(yaw),  0, std::sin(yaw), 0, 1, 0,
                         -std::sin(yaw), 0, std::cos(yaw)};
  return face;
}

using Kind = Unrest::Kind;

TEST(StillSecond, IsTakenFromAFaceThatHoldsStill) {
  Context c(kStillSecond);
  for (int i = 0; i < 30; ++i) {
    c.capture.Add(*Performer(i, 0.3F));
    EXPECT_EQ(c.capture.Finish().error(), Errc::kNotReady) << i;
  }
  c.capture.Add(*Performer(30, 0.3F));
  EXPECT_TRUE(c.capture.Finish());
  EXPECT_EQ(c.capture.unrest().kind, Kind::kNone);
}

// What is wrong shows as a number that a person can do something with.
TEST(StillSecond, SaysWhatMovedAndHowMuch) {
  struct Row {
    const char* name;
    std::unique_ptr<FacePose> (*face)(int frame);
    Kind kind;
    float measure;
  };
  const Row table[] = {
      {"one blink of 0.1 s", [](int i) { return Performer(i, i >= 12 && i < 15 ? 0.06F : 0.3F); },
       Kind::kEyesClosed, 0.8F},
      {"a blink of somebody whose lids hang",
       [](int i) { return Performer(i, i == 12 ? 0.06F : 0.15F); }, Kind::kEyesClosed, 0.6F},
      {"opens the eyes late", [](int i) { return Performer(i, i < 20 ? 0.12F : 0.3F); },
       Kind::kEyesClosed, 0.6F},
      {"eyes closed throughout", [](int i) { return Performer(i, 0.05F); }, Kind::kEyesClosed, 1},
      {"lips apart", [](int i) { return Performer(i, 0.3F, 0.3F); }, Kind::kMouthOpen, 0.3F},
      {"turns slowly by 12 degrees",
       [](int i) { return Performer(i, 0.3F, 0.1F, 0.4F * static_cast<float>(i)); },
       Kind::kHeadTurned, 6},
      {"leans by 4 cm",
       [](int i) {
         auto face = Performer(i, 0.3F);
         face->camera_t_head_cm.z += 4.0F * static_cast<float>(i) / 30;
         return face;
       },
       Kind::kHeadMoved, 2},
      {"says one word",
       [](int i) {
         auto face = Performer(i, 0.3F);
         for (std::size_t p = 180; p < 250 && i > 24; ++p) face->points_cm[p].y -= 0.5F;
         return face;
       },
       Kind::kFaceMoved, 0.5F},
  };
  for (const Row& row : table) {
    Context c(kStillSecond);
    for (int i = 0; i <= 30; ++i) c.capture.Add(*row.face(i));
    EXPECT_EQ(c.capture.Finish().error(), Errc::kRejected) << row.name;
    EXPECT_EQ(c.capture.unrest().kind, row.kind) << row.name;
    EXPECT_NEAR(c.capture.unrest().measure, row.measure, 0.05F) << row.name;
  }
}

TEST(StillSecond, TakesPeopleAsTheyAreAndJitterAsItIs) {
  Context c(kStillSecond);
  for (int i = 0; i <= 30; ++i) {
    const float wave = std::sin(static_cast<float>(i));
    auto face = Performer(i, 0.14F + 0.02F * wave, 0.15F, wave);  // hanging lids, parted lips
    for (std::size_t p = 0; p < face->count; ++p) face->points_cm[p].z += 0.1F * wave;
    c.capture.Add(*face);
  }
  EXPECT_TRUE(c.capture.Finish()) << static_cast<int>(c.capture.unrest().kind) << " by "
                                  << c.capture.unrest().measure;
}

TEST(StillSecond, ComesAsSoonAsTheBlinkIsBehindTheWindow) {
  Context c(kStillSecond);
  int taken_at = 0;
  for (int i = 0; i < 200 && taken_at == 0; ++i) {
    c.capture.Add(*Performer(i, i >= 10 && i < 14 ? 0.05F : 0.3F));
    if (c.capture.progress() < 1) continue;
    if (c.capture.Finish()) {
      taken_at = i;
    } else {
      c.capture.Slide();
    }
  }
  EXPECT_EQ(taken_at, 45) << "half a second after the first try";
}

TEST(StillSecond, NeedsAFewFramesHoweverSlowTheCamera) {
  Context c(kStillSecond);
  for (int i = 0; i < 7; ++i) {
    c.capture.Add(*Performer(10 * i, 0.3F));  // three frames a second
    EXPECT_EQ(c.capture.Finish().error(), Errc::kNotReady);
  }
  c.capture.Add(*Performer(70, 0.3F));
  EXPECT_TRUE(c.capture.Finish());
}

TEST(NeutralCapture, StartsOverByOtherRules) {
  Context c;
  for (int i = 0; i <= 60; ++i) c.capture.Add(*Face(i));
  ASSERT_TRUE(c.capture.Use(kStillSecond));
  EXPECT_EQ(c.capture.progress(), 0);
  EXPECT_EQ(c.capture.Use({.still_part = 1.1F}).error(), Errc::kOutOfRange);
  EXPECT_EQ(c.capture.config().still_part, 1) << "as before";
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
