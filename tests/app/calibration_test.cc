#include "app/calibration.h"

#include <gtest/gtest.h>

#include <vector>

namespace facewire::app {
namespace {

// A capture of one second, fed with a face whose lips are `gap_cm` apart, 30 times a second.
class Context {
 public:
  Context() : memory(retarget::NeutralCapture::RequiredBytes()) {
    Arena arena(memory);
    retarget::NeutralCaptureConfig config;
    config.duration = std::chrono::seconds(1);
    EXPECT_TRUE(capture.Configure(config, arena));
    face.count = kMaxLandmarks;
    for (std::size_t i = 0; i < face.count; ++i) {
      face.points_cm[i] = {static_cast<float>(i % 16), static_cast<float>(i / 16), 0};
    }
    face.points_cm[33] = {-4.5F, 2.7F, 3};
    face.points_cm[263] = {4.5F, 2.7F, 3};
    face.points_cm[13] = {0, -4, 5};
  }
  // The outcome within so many frames, if there is one.
  bool For(int frames, float gap_cm, bool seen = true) {
    face.points_cm[14] = {0, -4 - gap_cm, 5};
    for (int i = 0; i < frames; ++i) {
      face.captured += std::chrono::milliseconds(33);
      if (calibration.Update(seen ? &face : nullptr, outcome)) return true;
    }
    return false;
  }

  std::vector<std::byte> memory;
  retarget::NeutralCapture capture;
  Calibration calibration{capture};
  Calibration::Outcome outcome;
  FacePose face;
};

TEST(Calibration, DoesNothingUnasked) {
  Context c;
  EXPECT_FALSE(c.For(300, 0));
}

TEST(Calibration, TakesACalmFaceByItselfAndOnlyOnce) {
  Context c;
  c.calibration.BeginByItself();
  EXPECT_FALSE(c.For(20, 0)) << "not for long enough";
  ASSERT_TRUE(c.For(30, 0));
  EXPECT_TRUE(c.outcome.taken);
  EXPECT_FALSE(c.outcome.command);
  EXPECT_EQ(c.outcome.neutral.count, kMaxLandmarks);
  EXPECT_FALSE(c.For(300, 0));
}

TEST(Calibration, StartsOverByItselfWhenTheFaceIsLost) {
  Context c;
  c.calibration.BeginByItself();
  EXPECT_FALSE(c.For(25, 0));
  EXPECT_FALSE(c.For(1, 0, false));
  EXPECT_FALSE(c.For(25, 0));
  EXPECT_TRUE(c.For(30, 0));
}

TEST(Calibration, WaitsForClosedLipsByItselfButNotForEver) {
  Context c;
  c.calibration.BeginByItself();
  EXPECT_FALSE(c.For(150, 1)) << "a calm open smile";
  ASSERT_TRUE(c.For(90, 0.05F));
  EXPECT_LT(c.outcome.neutral.points_cm[13].y - c.outcome.neutral.points_cm[14].y, 0.1F);
  c.calibration.BeginByItself();
  EXPECT_TRUE(c.For(40 * Calibration::kPatience, 1)) << "some people's lips never close";
}

TEST(Calibration, TakesWhatACommandAsksFor) {
  Context c;
  ASSERT_TRUE(c.calibration.Begin({.id = 3, .code = wire::CommandCode::kCalibrateNeutral}));
  EXPECT_FALSE(c.calibration.Begin({.id = 4})) << "one at a time";
  ASSERT_TRUE(c.For(60, 1)) << "the performer was told to; open lips are his choice";
  ASSERT_TRUE(c.outcome.command);
  EXPECT_EQ(c.outcome.command->id, 3);
  EXPECT_EQ(c.outcome.result, wire::CommandResult::kOk);
}

TEST(Calibration, TellsACommandThatTheFaceWentAway) {
  Context c;
  ASSERT_TRUE(c.calibration.Begin({.id = 3}));
  EXPECT_FALSE(c.For(10, 0));
  ASSERT_TRUE(c.For(1, 0, false));
  EXPECT_EQ(c.outcome.result, wire::CommandResult::kNoFace);
  EXPECT_FALSE(c.outcome.taken);
}

TEST(Calibration, TellsACommandThatTheFaceMovedTooMuch) {
  Context c;
  ASSERT_TRUE(c.calibration.Begin({.id = 3}));
  bool ended = false;
  for (int i = 0; i < 60 && !ended; ++i) {
    for (std::size_t k = 0; k < c.face.count; ++k)
      c.face.points_cm[k].x += i % 2 == 0 ? 2.0F : -2.0F;
    ended = c.For(1, 0);
  }
  ASSERT_TRUE(ended);
  EXPECT_EQ(c.outcome.result, wire::CommandResult::kFailed);
}

}  // namespace
}  // namespace facewire::app
