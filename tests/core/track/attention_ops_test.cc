#include "core/track/attention_ops.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "core/base/capacity.h"

namespace facewire::track {
namespace {

struct Point {
  float x, y;
};

Point Apply(const CutTransform& t, float x, float y) {
  return {t.xx * x + t.xy * y + t.x0, t.yx * x + t.yy * y + t.y0};
}

void ExpectNear(Point actual, Point expected) {
  EXPECT_NEAR(actual.x, expected.x, 1e-4F);
  EXPECT_NEAR(actual.y, expected.y, 1e-4F);
}

// A part of four points; the first two lie on its horizontal axis.
class PartTransformTest : public testing::Test {
 protected:
  PartTransformTest() : mesh_(3 * kMeshLandmarks, 0.0F) {
    options_.left_rotation = 10;
    options_.right_rotation = 11;
    options_.output_width = 16;
    options_.output_height = 16;
    options_.scale_x = 1.5F;
    options_.scale_y = 1.5F;
    for (std::uint16_t i = 10; i < 14; ++i) EXPECT_TRUE(options_.subset.try_push(i));
  }
  void Place(std::size_t i, Point p) {
    mesh_[3 * i] = p.x;
    mesh_[3 * i + 1] = p.y;
  }
  // A diamond of the given half axes around a centre, turned.
  void PlaceDiamond(Point center, float half_w, float half_h, float angle) {
    const float c = std::cos(angle);
    const float s = std::sin(angle);
    Place(10, {center.x - half_w * c, center.y - half_w * s});
    Place(11, {center.x + half_w * c, center.y + half_w * s});
    Place(12, {center.x + half_h * s, center.y - half_h * c});
    Place(13, {center.x - half_h * s, center.y + half_h * c});
  }
  PartOptions options_;
  std::vector<float> mesh_;
};

TEST_F(PartTransformTest, AnUprightPartIsCutWithItsMargin) {
  PlaceDiamond({20, 30}, 8, 4, 0);
  const CutTransform t = PartTransform(options_, mesh_, 1.0F);
  ExpectNear(Apply(t, 8, 8), {20, 30});
  ExpectNear(Apply(t, 0, 0), {20 - 12, 30 - 6});
  ExpectNear(Apply(t, 16, 16), {20 + 12, 30 + 6});
}

TEST_F(PartTransformTest, ATurnedPartLiesLevelInItsCut) {
  const float angle = 0.4F;
  PlaceDiamond({20, 30}, 8, 4, angle);
  const CutTransform t = PartTransform(options_, mesh_, 1.0F);
  ExpectNear(Apply(t, 8, 8), {20, 30});
  // The right end of the part: half its width is two thirds of half the cut.
  ExpectNear(Apply(t, 8 + 8 / 1.5F, 8), {mesh_[33], mesh_[34]});
  // And its upper end.
  ExpectNear(Apply(t, 8, 8 - 8 / 1.5F), {mesh_[36], mesh_[37]});
}

TEST_F(PartTransformTest, ScalesTheMeshIntoTheMap) {
  PlaceDiamond({80, 120}, 32, 16, 0.3F);
  const CutTransform t = PartTransform(options_, mesh_, 0.25F);
  ExpectNear(Apply(t, 8, 8), {20, 30});
}

TEST_F(PartTransformTest, APartWithoutExtentGivesFiniteNumbers) {
  const CutTransform t = PartTransform(options_, mesh_, 1.0F);
  ExpectNear(Apply(t, 3, 5), {0, 0});
}

// A map whose value is a plane in x and y is reproduced exactly by bilinear sampling.
class CutFeaturesTest : public testing::Test {
 protected:
  static constexpr int kWidth = 6;
  static constexpr int kHeight = 5;
  static constexpr int kChannels = 2;
  CutFeaturesTest() {
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        values_.push_back(Plane(static_cast<float>(x) + 0.5F, static_cast<float>(y) + 0.5F));
        values_.push_back(-values_.back());
      }
    }
  }
  static float Plane(float x, float y) { return 10 * x + y + 100; }
  std::vector<float> Cut(const CutTransform& t) const {
    std::vector<float> cut(std::size_t{3} * 4 * kChannels, NAN);
    CutFeatures({values_, kWidth, kHeight, kChannels}, t, 4, 3, cut);
    return cut;
  }
  std::vector<float> values_;
};

TEST_F(CutFeaturesTest, SamplesAtTheCentresOfTheCells) {
  const CutTransform t = {0.5F, -0.25F, 2.0F, 0.25F, 0.5F, 1.0F};
  const auto cut = Cut(t);
  for (int y = 0; y < 3; ++y) {
    for (int x = 0; x < 4; ++x) {
      const Point at = Apply(t, static_cast<float>(x) + 0.5F, static_cast<float>(y) + 0.5F);
      const std::size_t i = (static_cast<std::size_t>(y) * 4 + x) * kChannels;
      EXPECT_NEAR(cut[i], Plane(at.x, at.y), 1e-3F);
      EXPECT_NEAR(cut[i + 1], -Plane(at.x, at.y), 1e-3F);
    }
  }
}

TEST_F(CutFeaturesTest, TheIdentityCopiesUpToTheLastCell) {
  const auto corner = Cut({1, 0, 2, 0, 1, 2});  // the lower right 4 x 3 cells
  EXPECT_EQ(corner[0], Plane(2.5F, 2.5F));
  EXPECT_EQ(corner[22], Plane(5.5F, 4.5F));
}

TEST_F(CutFeaturesTest, OutsideTheMapIsZero) {
  const auto cut = Cut({1, 0, -1, 0, 1, 0});
  EXPECT_EQ(cut[0], 0);
  EXPECT_EQ(cut[1], 0);
  EXPECT_EQ(cut[2], Plane(0.5F, 0.5F));
}

TEST_F(CutFeaturesTest, NumbersThatAreNoneAreOutside) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float inf = std::numeric_limits<float>::infinity();
  for (const CutTransform& t :
       {CutTransform{nan, nan, nan, nan, nan, nan}, CutTransform{inf, 0, 0, 0, inf, 0},
        CutTransform{1, 0, 1e30F, 0, 1, 0}, CutTransform{1, 0, -1e30F, 0, 1, 0}}) {
    for (const float v : Cut(t)) EXPECT_EQ(v, 0);
  }
}

}  // namespace
}  // namespace facewire::track
