#include "app/calibration.h"

#include <gtest/gtest.h>

#include <cmath>
#include <span>
#include <vector>

namespace facewire::app {
namespace {

retarget::NeutralCapture OfOneSecond(std::span<std::byte> memory) {
  Arena arena(memory);
  retarget::NeutralCapture capture;
  retarget::NeutralCaptureConfig config;
  config.duration = std::chrono::seconds(1);
  EXPECT_TRUE(capture.Configure(config, arena));
  return capture;
}

// A capture of one second, fed with a face whose lips are `gap_cm` apart, 30 times a second.
class Context {
 public:
  Context() {
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
      if (calibration.Update(face.captured, seen ? &face : nullptr, outcome)) return true;
    }
    return false;
  }

  std::vector<std::byte> memory = std::vector<std::byte>(retarget::NeutralCapture::RequiredBytes());
  retarget::NeutralCapture capture = OfOneSecond(memory);
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
  EXPECT_FALSE(c.outcome.request);
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

constexpr Request kAsked = {.command = {.id = 3, .code = wire::CommandCode::kCalibrateNeutral}};

// As For, with a head that nods to and fro by 10 degrees within every half second.
bool ForNodding(Context& c, int frames) {
  for (int i = 0; i < frames; ++i) {
    const float pitch = 0.17F * std::sin(static_cast<float>(i) / 2);
    c.face.camera_R_head = {
        1, 0, 0, 0, std::cos(pitch), -std::sin(pitch), 0, std::sin(pitch), std::cos(pitch)};
    if (c.For(1, 0)) return true;
  }
  return false;
}

TEST(Calibration, TakesWhatARequestAsksForAfterOneSecond) {
  Context c;
  ASSERT_TRUE(c.calibration.Begin(kAsked, c.face.captured));
  EXPECT_FALSE(c.For(31, 1)) << "the performer was told to; parted lips are his choice";
  ASSERT_TRUE(c.For(1, 1));
  ASSERT_TRUE(c.outcome.request);
  EXPECT_EQ(c.outcome.request->command.id, 3);
  EXPECT_EQ(c.outcome.result, wire::CommandResult::kOk);
  EXPECT_TRUE(c.outcome.taken);
}

TEST(Calibration, DoesOneRequestAtATimeAndKnowsItAgain) {
  Context c;
  ASSERT_TRUE(c.calibration.Begin(kAsked, c.face.captured));
  EXPECT_FALSE(c.For(20, 0));
  EXPECT_FALSE(c.calibration.Begin({.command = {.id = 4}}, c.face.captured));
  EXPECT_FALSE(c.calibration.Begin({.command = {.id = 3}, .asker = kButton}, c.face.captured));
  EXPECT_TRUE(c.calibration.Begin(kAsked, c.face.captured)) << "sent again, to be sure";
  EXPECT_TRUE(c.For(12, 0)) << "and not begun again";
}

TEST(Calibration, TellsWhoAskedThatTheFaceWentAway) {
  Context c;
  ASSERT_TRUE(c.calibration.Begin(kAsked, c.face.captured));
  EXPECT_FALSE(c.For(10, 0));
  ASSERT_TRUE(c.For(1, 0, false));
  EXPECT_EQ(c.outcome.result, wire::CommandResult::kNoFace);
  EXPECT_FALSE(c.outcome.taken);
}

TEST(Calibration, TakesTheFirstStillSecondHoweverLateItComes) {
  Context c;
  ASSERT_TRUE(c.calibration.Begin(kAsked, c.face.captured));
  EXPECT_FALSE(ForNodding(c, 240)) << "eight seconds";
  ASSERT_TRUE(c.For(60, 0));
  EXPECT_EQ(c.outcome.result, wire::CommandResult::kOk);
}

TEST(Calibration, GivesUpAfterTenSecondsAndSaysWhatWasWrong) {
  Context c;
  ASSERT_TRUE(c.calibration.Begin(kAsked, c.face.captured));
  EXPECT_FALSE(ForNodding(c, 300));
  ASSERT_TRUE(ForNodding(c, 20));
  EXPECT_EQ(c.outcome.result, wire::CommandResult::kHeadTurned);
  EXPECT_GT(c.outcome.measure, 8);
  EXPECT_LT(c.outcome.measure, 12);
  EXPECT_FALSE(c.outcome.taken);
  EXPECT_FALSE(ForNodding(c, 300)) << "it is over";
}

TEST(Calibration, GivesUpWhenNoPictureComes) {
  Context c;
  ASSERT_TRUE(c.calibration.Begin(kAsked, c.face.captured));
  EXPECT_FALSE(c.For(10, 0));
  Calibration::Outcome outcome;
  EXPECT_FALSE(c.calibration.Wait(c.face.captured + std::chrono::seconds(5), outcome));
  ASSERT_TRUE(c.calibration.Wait(c.face.captured + std::chrono::seconds(10), outcome));
  EXPECT_EQ(outcome.result, wire::CommandResult::kNoFace);
}

TEST(Calibration, StillTakesOneByItselfAfterARequestThatFailed) {
  Context c;
  c.calibration.BeginByItself();
  EXPECT_FALSE(c.For(20, 0));
  ASSERT_TRUE(c.calibration.Begin(kAsked, c.face.captured));
  ASSERT_TRUE(c.For(1, 0, false));
  ASSERT_TRUE(c.For(60, 0));
  EXPECT_FALSE(c.outcome.request);
  EXPECT_TRUE(c.outcome.taken);
}

TEST(Calibration, TakesNoneByItselfAfterARequestThatWasMet) {
  Context c;
  c.calibration.BeginByItself();
  ASSERT_TRUE(c.calibration.Begin(kAsked, c.face.captured));
  ASSERT_TRUE(c.For(60, 0));
  EXPECT_FALSE(c.For(300, 0)) << "the performer's own choice is not replaced";
}

}  // namespace
}  // namespace facewire::app
