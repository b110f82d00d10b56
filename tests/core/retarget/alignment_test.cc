#include "core/retarget/alignment.h"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

namespace facewire::retarget {
namespace {

// Outer eye corners, inner brows, chin.
const std::vector<std::int16_t> kFace = {33, 263, 107, 336, 152};
const std::vector<Point3> kSource = {{-4, 3, 0}, {4, 3, 0}, {-1, 5, 1}, {1, 5, 1}, {0, -7, 2}};

std::vector<Point3> Stretched(float across, float down, Point3 shift) {
  std::vector<Point3> out;
  for (const Point3 p : kSource) out.push_back(shift + Point3{across * p.x, down * p.y, p.z});
  return out;
}

TEST(Align, TakesTheScaleAcrossFromTheEyesAndDownFromBrowsToChin) {
  const auto target = Stretched(2, 0.5F, {10, 20, 30});
  const auto alignment = Align(kSource, target, kFace);
  ASSERT_TRUE(alignment);
  EXPECT_FLOAT_EQ(alignment->scale.x, 2);
  EXPECT_FLOAT_EQ(alignment->scale.y, 0.5F);
  EXPECT_FLOAT_EQ(alignment->scale.z, 1);
  const Point3 eye = (*alignment)(kSource[0]);
  EXPECT_NEAR(eye.x, target[0].x, 1e-5);
  EXPECT_NEAR(eye.y, target[0].y, 1e-5);
}

TEST(Align, WithoutEyesOrChinTheSpreadGivesTheScale) {
  const std::vector<std::int16_t> nowhere(5, -1);
  std::vector<Point3> target;
  for (const Point3 p : kSource) target.push_back(3.0F * p);
  const auto alignment = Align(kSource, target, nowhere);
  ASSERT_TRUE(alignment);
  EXPECT_NEAR(alignment->scale.x, 3, 1e-5);
  EXPECT_NEAR(alignment->scale.y, 3, 1e-5);
}

TEST(Align, ACyclopsWithItsEyesAMillimetreApartIsScaledByTheSpread) {
  auto target = kSource;
  target[0].x = -0.05F;
  target[1].x = 0.05F;
  const auto alignment = Align(kSource, target, kFace);
  ASSERT_TRUE(alignment);
  EXPECT_GT(alignment->scale.x, 0.5F);
  EXPECT_FLOAT_EQ(alignment->scale.y, 1);
}

TEST(Align, OnePointIsMovedWithoutScaling) {
  const std::vector<Point3> source = {{1, 2, 3}};
  const std::vector<Point3> target = {{4, 4, 4}};
  const std::vector<std::int16_t> landmarks = {152};
  const auto alignment = Align(source, target, landmarks);
  ASSERT_TRUE(alignment);
  EXPECT_EQ(alignment->scale, (Point3{1, 1, 1}));
  EXPECT_EQ((*alignment)({2, 2, 3}), (Point3{5, 4, 4}));
}

TEST(Align, RefusesPointsInOnePlaceAndPointsThatAreNotFinite) {
  const std::vector<Point3> one_place(5, Point3{1, 1, 1});
  EXPECT_EQ(Align(one_place, kSource, kFace).error(), Errc::kSingular);
  auto broken = kSource;
  broken[2].y = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(Align(broken, kSource, kFace).error(), Errc::kInvalidArgument);
  EXPECT_EQ(Align({}, {}, {}).error(), Errc::kInvalidArgument);
}

}  // namespace
}  // namespace facewire::retarget
