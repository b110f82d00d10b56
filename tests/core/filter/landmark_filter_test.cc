#include "core/filter/landmark_filter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include "tests/support/allocation_counter.h"
#include "tests/support/generated_face.h"

namespace facewire::filter {
namespace {

using std::chrono::hours;
using std::chrono::microseconds;
using std::chrono::milliseconds;
using test::GeneratedFace;
using test::Photograph;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr std::size_t kUpperLid = 159;
constexpr std::size_t kLowerLip = 14;
constexpr std::size_t kBrow = 105;

Landmarks FaceAt(Duration at, float x_px = 0, float scale_px_per_cm = 7) {
  Landmarks face = Photograph(
      GeneratedFace(), {.scale_px_per_cm = scale_px_per_cm, .origin_px = {320 + x_px, 240, 0}});
  face.captured = Time(at);
  return face;
}

float SizeOf(const Landmarks& face) { return MeasureFace(face, {})->size_px; }

class LandmarkFilterTest : public testing::Test {
 protected:
  Result<Landmarks> Call(const Landmarks& in) { return filter_.Update(in); }
  bool Accepts(const Landmarks& in) { return Call(in).has_value(); }

  LandmarkFilter filter_{FilterConfig{}};
};

TEST_F(LandmarkFilterTest, TheFirstLandmarksPassUnchanged) {
  const Landmarks in = FaceAt(milliseconds(0));
  const auto out = Call(in);
  ASSERT_TRUE(out);
  EXPECT_EQ(out->points_px, in.points_px);
}

TEST_F(LandmarkFilterTest, EverythingButThePointsPassesThrough) {
  Call(FaceAt(milliseconds(0))).value();
  Landmarks in = FaceAt(milliseconds(40), 1);
  in.seq = 12;
  in.presence = 0.875F;
  const auto out = Call(in);
  ASSERT_TRUE(out);
  EXPECT_EQ(out->seq, 12U);
  EXPECT_EQ(out->captured, in.captured);
  EXPECT_EQ(out->presence, 0.875F);
  EXPECT_EQ(out->width_px, 640);
  EXPECT_EQ(out->height_px, 480);
  EXPECT_EQ(out->count, kMaxLandmarks);
  EXPECT_NE(out->points_px, in.points_px);
}

TEST_F(LandmarkFilterTest, AfterResetTheNextLandmarksPassUnchanged) {
  Call(FaceAt(milliseconds(0))).value();
  filter_.Reset();
  const Landmarks in = FaceAt(milliseconds(40), 5);
  EXPECT_EQ(Call(in)->points_px, in.points_px);
}

// Pins the formula: speed is measured against the last filtered value (not the last raw one),
// divided by the face size, smoothed, and what exceeds the floor opens the low-pass.
TEST_F(LandmarkFilterTest, FollowsTheFormulaOfItsHeader) {
  const FilterConfig config;
  const std::vector<double> x = {0, 0.5, 1.5, 1.25, 4, 9, 9, 9.5, 2, 2};
  const std::vector<int> at_ms = {0, 33, 66, 120, 130, 170, 203, 403, 440, 470};
  const OneEuroConfig& c = config.rest;
  const auto share = [](double cutoff, double dt) {
    return 1 / (1 + 1 / (2 * std::numbers::pi * cutoff * dt));
  };
  double value = 0;
  double speed = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    Landmarks in = FaceAt(milliseconds(at_ms[i]));
    in.points_px[kBrow].z += static_cast<float>(x[i]);
    const auto out = Call(in);
    ASSERT_TRUE(out);
    if (i > 0) {
      const double dt = (at_ms[i] - at_ms[i - 1]) * 1e-3;
      speed += share(c.derivative_cutoff_hz, dt) * ((x[i] - value) / dt / SizeOf(in) - speed);
      const double cutoff =
          c.min_cutoff_hz + c.beta * std::max(0.0, std::abs(speed) - c.speed_floor);
      value += share(cutoff, dt) * (x[i] - value);
    }
    const float moved = out->points_px[kBrow].z - FaceAt(Duration{}).points_px[kBrow].z;
    ASSERT_NEAR(moved, value, 1e-4) << "step " << i;
  }
}

TEST_F(LandmarkFilterTest, TheRegionsHaveTheirOwnSettings) {
  const OneEuroConfig open{1e6F, 0, 1, 0};  // passes everything
  const OneEuroConfig shut{1e-6F, 0, 1, 0};
  const auto passes = [&](const FilterConfig& config, std::size_t landmark) {
    LandmarkFilter filter(config);
    filter.Update(FaceAt(milliseconds(0))).value();
    const Landmarks in = FaceAt(milliseconds(33), 3);
    return std::abs(filter.Update(in)->points_px[landmark].x - in.points_px[landmark].x) < 0.01F;
  };
  const FilterConfig eyes{.eyes = open, .mouth = shut, .rest = shut};
  EXPECT_TRUE(passes(eyes, kUpperLid));
  EXPECT_TRUE(passes(eyes, 473)) << "an iris";
  EXPECT_FALSE(passes(eyes, kLowerLip));
  EXPECT_FALSE(passes(eyes, kBrow));
  const FilterConfig mouth{.eyes = shut, .mouth = open, .rest = shut};
  EXPECT_FALSE(passes(mouth, kUpperLid));
  EXPECT_TRUE(passes(mouth, kLowerLip));
  EXPECT_FALSE(passes(mouth, kBrow));
  const FilterConfig rest{.eyes = shut, .mouth = shut, .rest = open};
  EXPECT_FALSE(passes(rest, kUpperLid));
  EXPECT_FALSE(passes(rest, kLowerLip));
  EXPECT_TRUE(passes(rest, kBrow));
}

TEST_F(LandmarkFilterTest, ABlinkKeepsItsDepth) {
  for (int fps : {24, 30}) {
    for (int frames : {3, 4, 5}) {
      LandmarkFilter filter{FilterConfig{}};
      std::mt19937 random(7);
      std::normal_distribution<float> jitter(0, 0.09F);
      const float depth_px = 0.05F * SizeOf(FaceAt(Duration{}));
      float lowest = 0;
      for (int i = 0; i < fps + 2 * frames; ++i) {
        Landmarks in = FaceAt(microseconds(1000000LL * i / fps));
        const float open_y = in.points_px[kUpperLid].y;
        for (Point3& p : in.points_px)
          p = p + Point3{jitter(random), jitter(random), jitter(random)};
        const int phase = i - fps + 1;
        float closed = 0;
        if (phase > 0 && phase <= frames) {
          closed =
              0.5F - 0.5F * std::cos(2 * std::numbers::pi_v<float> * static_cast<float>(phase) /
                                     static_cast<float>(frames + 1));
        }
        // Of four frames none is at the very bottom; measure against the deepest that there is.
        in.points_px[kUpperLid].y += closed * depth_px;
        lowest = std::max(lowest, filter.Update(in)->points_px[kUpperLid].y - open_y);
      }
      const float deepest =
          frames % 2 == 1 ? 1.F : 0.5F - 0.5F * std::cos(0.8F * std::numbers::pi_v<float>);
      EXPECT_GT(lowest, 0.9F * deepest * depth_px) << frames << " frames at " << fps << " fps";
    }
  }
}

TEST_F(LandmarkFilterTest, AStillFaceGetsAtLeastThreeTimesStiller) {
  for (int fps : {24, 30}) {
    LandmarkFilter filter{FilterConfig{}};
    std::mt19937 random(5);
    std::normal_distribution<float> jitter(0, 0.09F);  // as measured at this face size
    const Landmarks still = FaceAt(Duration{});
    ASSERT_NEAR(SizeOf(still), 130, 10);
    double before = 0;
    double after = 0;
    for (int i = 0; i < 200; ++i) {
      Landmarks in = FaceAt(microseconds(1000000LL * i / fps));
      for (Point3& p : in.points_px) p = p + Point3{jitter(random), jitter(random), jitter(random)};
      const auto out = filter.Update(in);
      ASSERT_TRUE(out);
      if (i < 50) continue;
      for (std::size_t k = 0; k < kMaxLandmarks; ++k) {
        const Point3 noise = in.points_px[k] - still.points_px[k];
        const Point3 left = out->points_px[k] - still.points_px[k];
        before += double{Dot(noise, noise)};
        after += double{Dot(left, left)};
      }
    }
    EXPECT_GT(std::sqrt(before / after), 3) << fps << " fps";
  }
}

TEST_F(LandmarkFilterTest, ASlowMotionIsFollowedClosely) {
  // 3 px a second: slower than the floor, and must not be swallowed.
  float largest = 0;
  for (int i = 0; i < 200; ++i) {
    const Landmarks in = FaceAt(milliseconds(33 * i), 0.1F * static_cast<float>(i));
    largest = std::max(largest, in.points_px[kBrow].x - Call(in)->points_px[kBrow].x);
  }
  EXPECT_LT(largest, 0.35F);
}

TEST_F(LandmarkFilterTest, TheDistanceToTheCameraDoesNotMatter) {
  LandmarkFilter near_filter{FilterConfig{}};
  LandmarkFilter far_filter{FilterConfig{}};
  for (int i = 0; i < 60; ++i) {
    const float sway = std::sin(0.3F * static_cast<float>(i));
    const auto far = far_filter.Update(FaceAt(milliseconds(33 * i), 3 * sway, 5));
    const auto near = near_filter.Update(FaceAt(milliseconds(33 * i), 12 * sway, 20));
    ASSERT_TRUE(far && near);
    ASSERT_NEAR((near->points_px[kBrow].x - 320) / 20, (far->points_px[kBrow].x - 320) / 5, 1e-4);
  }
}

TEST_F(LandmarkFilterTest, IrregularFramesStayOnTheMotion) {
  std::mt19937 random(9);
  std::uniform_int_distribution<int> step_ms(5, 120);
  int ms = 0;
  for (int i = 0; i < 300; ++i) {
    ms += step_ms(random);
    const float x = 20 * std::sin(2 * static_cast<float>(ms) * 1e-3F);
    const Landmarks in = FaceAt(milliseconds(ms), x);
    const auto out = Call(in);
    ASSERT_TRUE(out);
    ASSERT_NEAR(out->points_px[kBrow].x, in.points_px[kBrow].x, 1.2F);
  }
}

TEST_F(LandmarkFilterTest, TheSameInstantHasOneAnswer) {
  Call(FaceAt(milliseconds(0))).value();
  const auto first = Call(FaceAt(milliseconds(40), 4));
  Landmarks again = FaceAt(milliseconds(40), 2);
  again.seq = 3;
  const auto second = Call(again);
  ASSERT_TRUE(first && second);
  EXPECT_EQ(second->points_px, first->points_px);
  EXPECT_EQ(second->seq, 3U);
}

TEST_F(LandmarkFilterTest, TimeThatGoesBackwardsStartsAgain) {
  Call(FaceAt(hours(1))).value();
  const Landmarks earlier = FaceAt(hours(1) - milliseconds(1), 3);
  EXPECT_EQ(Call(earlier)->points_px, earlier.points_px);
  const Landmarks much_earlier = FaceAt(Duration::min(), 200);
  EXPECT_EQ(Call(much_earlier)->points_px, much_earlier.points_px);
  const Landmarks much_later = FaceAt(Duration::max(), -100);
  EXPECT_EQ(Call(much_later)->points_px, much_later.points_px);
}

TEST_F(LandmarkFilterTest, AfterAGapAnythingGoesUnfiltered) {
  Call(FaceAt(milliseconds(0))).value();
  const Landmarks at_the_limit = FaceAt(milliseconds(500), 3);
  EXPECT_NE(Call(at_the_limit)->points_px, at_the_limit.points_px);
  const Landmarks after = FaceAt(milliseconds(1001), -250, 3);
  EXPECT_EQ(Call(after)->points_px, after.points_px);
}

TEST_F(LandmarkFilterTest, AnotherNetworkOrPictureSizeStartsAgain) {
  Call(FaceAt(milliseconds(0))).value();
  Landmarks mesh = FaceAt(milliseconds(33), 3);
  mesh.count = kMeshLandmarks;
  EXPECT_EQ(Call(mesh)->points_px, mesh.points_px);
  Landmarks full = FaceAt(milliseconds(66), 6);
  EXPECT_EQ(Call(full)->points_px, full.points_px);
  Landmarks larger = FaceAt(milliseconds(99), 200, 14);
  larger.width_px = 1280;
  EXPECT_EQ(Call(larger)->points_px, larger.points_px);
}

TEST_F(LandmarkFilterTest, WhatIsNoFaceIsRejected) {
  const auto rejects = [&](auto change) {
    filter_.Reset();
    Landmarks bad = FaceAt(milliseconds(0));
    change(bad);
    const auto out = Call(bad);
    return !out && out.error() == Errc::kRejected;
  };
  EXPECT_FALSE(rejects([](Landmarks& l) { l.presence = 0.5F; }));
  EXPECT_TRUE(rejects([](Landmarks& l) { l.presence = 0.49F; }));
  EXPECT_TRUE(rejects([](Landmarks& l) { l.presence = kNan; }));
  EXPECT_TRUE(rejects([](Landmarks& l) { l.count = 0; }));
  EXPECT_TRUE(rejects([](Landmarks& l) { l.count = 470; }));
  EXPECT_TRUE(rejects([](Landmarks& l) { l.points_px[200].y = kNan; }));
  EXPECT_TRUE(rejects([](Landmarks& l) { l.points_px[477].z = -INFINITY; }));
  EXPECT_TRUE(rejects([](Landmarks& l) { l.points_px[200].y = 1e20F; }));
  EXPECT_TRUE(rejects([](Landmarks& l) { l.points_px.fill({3, 3, 3}); }));
  EXPECT_TRUE(rejects([](Landmarks& l) {
    for (Point3& p : l.points_px) p = {320 + 0.05F * (p.x - 320), 240 + 0.05F * (p.y - 240), 0};
  })) << "too small";
  EXPECT_TRUE(rejects([](Landmarks& l) {
    for (std::size_t i = 1; i < kMaxLandmarks; ++i) l.points_px[i] = {100, 100, 0};
  })) << "fallen together but for one point";
  EXPECT_TRUE(rejects([](Landmarks& l) {
    for (Point3& p : l.points_px) p = {p.x, 240, 0};
  })) << "without height";
}

TEST_F(LandmarkFilterTest, OneBadFrameCostsOneFrame) {
  Call(FaceAt(milliseconds(0))).value();
  Landmarks bad = FaceAt(milliseconds(33));
  bad.points_px[5].x = kNan;
  EXPECT_FALSE(Accepts(bad));
  EXPECT_FALSE(Accepts(FaceAt(milliseconds(66), 280)));
  const Landmarks back = FaceAt(milliseconds(99), 1);
  const auto out = Call(back);
  ASSERT_TRUE(out);
  EXPECT_NE(out->points_px, back.points_px) << "filtering goes on from before";
}

TEST_F(LandmarkFilterTest, AJumpOrAChangeOfSizeIsRejected) {
  Call(FaceAt(milliseconds(0))).value();
  EXPECT_TRUE(Accepts(FaceAt(milliseconds(33), 30))) << "a quick head";
  EXPECT_FALSE(Accepts(FaceAt(milliseconds(66), 130))) << "0.77 face sizes in a frame";
  filter_.Reset();
  Call(FaceAt(milliseconds(0), 0, 7)).value();
  EXPECT_FALSE(Accepts(FaceAt(milliseconds(33), 0, 11)));
  filter_.Reset();
  Call(FaceAt(milliseconds(0), 0, 7)).value();
  EXPECT_FALSE(Accepts(FaceAt(milliseconds(33), 0, 4.5F)));
}

TEST_F(LandmarkFilterTest, AFaceThatReallyIsElsewhereIsTakenAtTheThirdMeasurement) {
  Call(FaceAt(milliseconds(0))).value();
  EXPECT_FALSE(Accepts(FaceAt(milliseconds(33), 280)));
  EXPECT_FALSE(Accepts(FaceAt(milliseconds(66), 281)));
  const Landmarks there = FaceAt(milliseconds(99), 282);
  const auto out = Call(there);
  ASSERT_TRUE(out);
  EXPECT_EQ(out->points_px, there.points_px);
  EXPECT_TRUE(Accepts(FaceAt(milliseconds(132), 283)));
}

TEST_F(LandmarkFilterTest, RepeatingOneMeasurementDoesNotMakeItTrue) {
  Call(FaceAt(milliseconds(0))).value();
  for (int i = 0; i < 10; ++i) EXPECT_FALSE(Accepts(FaceAt(milliseconds(33), 280)));
}

TEST_F(LandmarkFilterTest, MeasurementsThatDoNotAgreeAreNotBelievedBeforeTheGap) {
  Call(FaceAt(milliseconds(0))).value();
  int accepted_ms = 0;
  for (int i = 1; i < 100 && accepted_ms == 0; ++i) {
    // Alternating in size, so that distance in time never makes it plausible.
    if (Accepts(FaceAt(milliseconds(33 * i), 0, i % 2 == 0 ? 2.F : 20.F))) accepted_ms = 33 * i;
  }
  EXPECT_GT(accepted_ms, 500);
  EXPECT_LT(accepted_ms, 550) << "no lock-up: after the gap it starts again";
}

TEST_F(LandmarkFilterTest, WhateverComesInItNeverLocksUpAndWhatComesOutIsFinite) {
  std::mt19937 random(21);
  std::normal_distribution<float> noise;
  Duration at{};
  for (int round = 0; round < 200; ++round) {
    for (int i = 0; i < 10; ++i) {
      at += microseconds(static_cast<int>(random() % 200000) - 40000);
      const float size = std::pow(10.F, noise(random));
      Landmarks in = FaceAt(at, 200 * noise(random), size);
      if (random() % 4 == 0) in.points_px[random() % kMaxLandmarks].x = kNan;
      if (random() % 4 == 0) in.points_px[random() % kMaxLandmarks].y = 1e5F * noise(random);
      const auto out = Call(in);
      if (!out) continue;
      for (const Point3& p : out->points_px) ASSERT_TRUE(std::isfinite(p.x + p.y + p.z));
    }
    // Then a face that is simply there.
    bool accepted = false;
    for (int i = 0; i < 3; ++i) {
      at += milliseconds(33);
      accepted = Accepts(FaceAt(at));
    }
    ASSERT_TRUE(accepted) << "round " << round;
  }
}

TEST(FilterConfigTest, IsChecked) {
  EXPECT_TRUE(Validate(FilterConfig{}));
  const auto refuses = [](auto change) {
    FilterConfig config;
    change(config);
    const auto result = Validate(config);
    return !result && result.error() == Errc::kOutOfRange;
  };
  EXPECT_TRUE(refuses([](FilterConfig& c) { c.eyes.min_cutoff_hz = 0; }));
  EXPECT_TRUE(refuses([](FilterConfig& c) { c.mouth.beta = -1; }));
  EXPECT_TRUE(refuses([](FilterConfig& c) { c.rest.derivative_cutoff_hz = kNan; }));
  EXPECT_TRUE(refuses([](FilterConfig& c) { c.rest.speed_floor = INFINITY; }));
  EXPECT_TRUE(refuses([](FilterConfig& c) { c.plausibility.min_presence = 1.5F; }));
  EXPECT_TRUE(refuses([](FilterConfig& c) { c.plausibility.min_size_px = 0; }));
  EXPECT_TRUE(refuses([](FilterConfig& c) { c.plausibility.max_speed_sizes_per_s = 0; }));
  EXPECT_TRUE(refuses([](FilterConfig& c) { c.plausibility.max_size_ratio = 1; }));
  EXPECT_TRUE(refuses([](FilterConfig& c) { c.believe_after = 0; }));
  EXPECT_TRUE(refuses([](FilterConfig& c) { c.max_gap = Duration::zero(); }));
}

TEST(LandmarkFilterMemory, UpdateAllocatesNothing) {
  if (!test::AllocationCounter::kAvailable) GTEST_SKIP() << test::AllocationCounter::kWhyNot;
  LandmarkFilter filter{FilterConfig{}};
  std::vector<Landmarks> frames;
  frames.reserve(10);
  for (int i = 0; i < 10; ++i) frames.push_back(FaceAt(milliseconds(33 * i), i == 5 ? 300.F : 0.F));
  int accepted = 0;
  test::AllocationCounter counter;
  counter.Arm();
  for (const Landmarks& frame : frames) accepted += filter.Update(frame) ? 1 : 0;
  counter.Disarm();
  EXPECT_EQ(accepted, 9);
  EXPECT_EQ(counter.allocations(), 0U);
  EXPECT_EQ(counter.frees(), 0U);
}

}  // namespace
}  // namespace facewire::filter
