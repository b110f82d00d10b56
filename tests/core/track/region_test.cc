#include "core/track/region.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "core/base/capacity.h"

namespace facewire::track {
namespace {

TEST(RegionTest, OfADetectionIsASquareAroundItsBoxLevelWithTheEyes) {
  Detection d = {.score = 1, .min_x_px = 10, .min_y_px = 20, .max_x_px = 50, .max_y_px = 80};
  d.keypoints_px[0] = {20, 30, 0};
  d.keypoints_px[1] = {40, 50, 0};
  const Region r = RegionOf(d);
  EXPECT_FLOAT_EQ(r.center_x_px, 30);
  EXPECT_FLOAT_EQ(r.center_y_px, 50);
  EXPECT_FLOAT_EQ(r.side_px, 90);
  EXPECT_FLOAT_EQ(r.angle_rad, std::numbers::pi_v<float> / 4);
}

TEST(RegionTest, OfLandmarksIsASquareAroundAllOfThemLevelWithTheEyeCorners) {
  std::vector<Point3> points(kMeshLandmarks, Point3{50, 50, 9});
  points[0] = {0, 40, 0};
  points[1] = {100, 60, 0};
  points[33] = {40, 50, 0};
  points[263] = {60, 50 - 20 * std::tan(0.1F), 0};
  const Region r = RegionOf(points);
  EXPECT_FLOAT_EQ(r.center_x_px, 50);
  EXPECT_FLOAT_EQ(r.center_y_px, 50);
  EXPECT_FLOAT_EQ(r.side_px, 150);
  EXPECT_NEAR(r.angle_rad, -0.1F, 1e-6F);
}

TEST(RegionTest, TakesPointsOfTheCropBackToThePicture) {
  const CropToPicture to_picture(
      {.center_x_px = 100, .center_y_px = 50, .side_px = 96, .angle_rad = 0.5F}, 192);
  const Point3 center = to_picture({96, 96, 8});
  EXPECT_NEAR(center.x, 100, 1e-4);
  EXPECT_NEAR(center.y, 50, 1e-4);
  EXPECT_NEAR(center.z, 4, 1e-6);
  const Point3 right = to_picture({192, 96, 0});
  EXPECT_NEAR(right.x, 100 + 48 * std::cos(0.5), 1e-4);
  EXPECT_NEAR(right.y, 50 + 48 * std::sin(0.5), 1e-4);
  const Point3 bottom = to_picture({96, 192, 0});
  EXPECT_NEAR(bottom.x, 100 - 48 * std::sin(0.5), 1e-4);
  EXPECT_NEAR(bottom.y, 50 + 48 * std::cos(0.5), 1e-4);
}

TEST(RegionTest, OnlyFiniteAndSensibleRegionsAreUsable) {
  const Region good = {.center_x_px = 10, .center_y_px = 10, .side_px = 100, .angle_rad = 0};
  EXPECT_TRUE(IsUsable(good));
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float inf = std::numeric_limits<float>::infinity();
  for (const float bad : {nan, inf, -inf, 1e9F}) {
    for (float Region::*field :
         {&Region::center_x_px, &Region::center_y_px, &Region::side_px, &Region::angle_rad}) {
      Region r = good;
      r.*field = bad;
      EXPECT_FALSE(IsUsable(r)) << bad;
    }
  }
  Region tiny = good;
  tiny.side_px = 0.5F;
  EXPECT_FALSE(IsUsable(tiny));
}

}  // namespace
}  // namespace facewire::track
