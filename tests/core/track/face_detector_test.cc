#include "core/track/face_detector.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>

namespace facewire::track {
namespace {

TEST(AnchorsTest, AreTheCentresOfBothGridsCellByCell) {
  const Anchors anchors = MakeAnchors();
  EXPECT_FLOAT_EQ(anchors[0].x, 0.5F / 16);
  EXPECT_FLOAT_EQ(anchors[1].x, 0.5F / 16);  // two at each cell
  EXPECT_FLOAT_EQ(anchors[2].x, 1.5F / 16);
  EXPECT_FLOAT_EQ(anchors[2].y, 0.5F / 16);
  EXPECT_FLOAT_EQ(anchors[32].x, 0.5F / 16);  // the next row
  EXPECT_FLOAT_EQ(anchors[32].y, 1.5F / 16);
  EXPECT_FLOAT_EQ(anchors[512].x, 0.5F / 8);  // the coarse grid, six at each cell
  EXPECT_FLOAT_EQ(anchors[517].x, 0.5F / 8);
  EXPECT_FLOAT_EQ(anchors[518].x, 1.5F / 8);
  EXPECT_FLOAT_EQ(anchors[895].x, 7.5F / 8);
  EXPECT_FLOAT_EQ(anchors[895].y, 7.5F / 8);
}

// Tensors without any face, to which a test adds some.
class DecodeTest : public testing::Test {
 protected:
  DecodeTest() : anchors_(MakeAnchors()) { scores_.fill(-50); }

  // A box in pixels of the 128 x 128 input.
  void Put(std::size_t i, float logit, float x, float y, float w, float h) {
    scores_[i] = logit;
    float* box = &boxes_[i * kBoxNumbers];
    box[0] = x - 128 * anchors_[i].x;
    box[1] = y - 128 * anchors_[i].y;
    box[2] = w;
    box[3] = h;
    for (int k = 0; k < 6; ++k) {
      box[4 + 2 * k] = x + static_cast<float>(k) - 128 * anchors_[i].x;
      box[5 + 2 * k] = y - static_cast<float>(k) - 128 * anchors_[i].y;
    }
  }
  Result<Detection> Decode(float min_score = 0.5F) const {
    return DecodeBest({scores_, boxes_}, anchors_, min_score);
  }

  Anchors anchors_;
  std::array<float, kAnchors> scores_{};
  std::array<float, kAnchors * kBoxNumbers> boxes_{};
};

TEST_F(DecodeTest, NothingAboveTheThresholdIsNoFace) {
  EXPECT_EQ(Decode().error(), Errc::kNoFace);
  Put(100, -0.01F, 64, 64, 32, 32);
  EXPECT_EQ(Decode().error(), Errc::kNoFace);
}

TEST_F(DecodeTest, TheThresholdItselfCounts) {
  Put(100, 0, 64, 64, 32, 32);
  EXPECT_TRUE(Decode());
}

TEST_F(DecodeTest, OneCandidateIsTakenAsItIs) {
  Put(300, 2, 64, 32, 32, 16);
  const auto d = Decode();
  ASSERT_TRUE(d);
  EXPECT_FLOAT_EQ(d->score, 1 / (1 + std::exp(-2.0F)));
  EXPECT_FLOAT_EQ(d->min_x_px, 48.0F / 128);
  EXPECT_FLOAT_EQ(d->max_x_px, 80.0F / 128);
  EXPECT_FLOAT_EQ(d->min_y_px, 24.0F / 128);
  EXPECT_FLOAT_EQ(d->max_y_px, 40.0F / 128);
  EXPECT_FLOAT_EQ(d->keypoints_px[1].x, 65.0F / 128);
  EXPECT_FLOAT_EQ(d->keypoints_px[5].y, 27.0F / 128);
}

TEST_F(DecodeTest, OverlappingCandidatesAreAveragedByTheirScores) {
  Put(300, 100, 64, 64, 32, 32);  // score 1
  Put(700, 0, 67, 64, 32, 32);    // score 0.5
  const auto d = Decode();
  ASSERT_TRUE(d);
  EXPECT_FLOAT_EQ(d->score, 1);
  EXPECT_NEAR(d->min_x_px, (48 + 1) / 128.0, 1e-6);
  EXPECT_NEAR(d->keypoints_px[0].x, 65 / 128.0, 1e-6);
}

TEST_F(DecodeTest, AnotherFaceElsewhereDoesNotMixIn) {
  Put(300, 3, 30, 30, 20, 20);
  Put(700, 2, 90, 90, 20, 20);
  const auto d = Decode();
  ASSERT_TRUE(d);
  EXPECT_FLOAT_EQ(d->min_x_px, 20.0F / 128);
  EXPECT_FLOAT_EQ(d->max_y_px, 40.0F / 128);
}

TEST_F(DecodeTest, JustTooLittleOverlapDoesNotMixIn) {
  Put(300, 3, 64, 64, 20, 20);
  Put(700, 2, 75, 64, 20, 20);  // 9 of 31 columns in common: 0.29
  EXPECT_FLOAT_EQ(Decode()->min_x_px, 54.0F / 128);
  Put(700, 2, 74, 64, 20, 20);  // 10 of 30: 0.33
  EXPECT_GT(Decode()->min_x_px, 54.0F / 128);
}

TEST_F(DecodeTest, HugeLogitsAreClipped) {
  Put(300, 1e30F, 64, 64, 32, 32);
  EXPECT_FLOAT_EQ(Decode()->score, 1);
}

TEST_F(DecodeTest, NumbersThatAreNoneAreNoFace) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  scores_.fill(nan);
  EXPECT_EQ(Decode().error(), Errc::kNoFace);
  Put(300, 2, 64, 64, 32, 32);
  EXPECT_FLOAT_EQ(Decode()->min_x_px, 48.0F / 128);
}

TEST(FaceDetectorTest, IsNotReadyBeforeItIsBuilt) {
  const auto detector = std::make_unique<FaceDetector>();
  EXPECT_EQ(detector->Detect({}, 0.5F).error(), Errc::kNotReady);
}

}  // namespace
}  // namespace facewire::track
