#include "core/retarget/geometry_mapping.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace facewire::retarget {
namespace {

// A mapping with its memory.
struct Context {
  std::vector<std::byte> block, workspace;
  GeometryMapping mapping;

  Result<> Solve(const std::vector<Point3>& source, const std::vector<Point3>& target) {
    block.resize(GeometryMapping::RequiredBytes(source.size()));
    workspace.resize(GeometryMapping::WorkspaceBytes(source.size()));
    Arena arena(block);
    EXPECT_TRUE(mapping.Reserve(source.size(), arena));
    const std::vector<std::int16_t> landmarks(source.size(), -1);
    return mapping.Solve(source, target, landmarks, workspace);
  }
};

// A grid over a face, 16 x 12 cm, bulging towards the camera.
std::vector<Point3> Face() {
  std::vector<Point3> points;
  for (float y = -8; y <= 8; y += 2)
    for (float x = -6; x <= 6; x += 2) points.push_back({x, y, 4 - 0.05F * (x * x + y * y)});
  return points;
}

// A smooth deformation into a wider, longer-jawed face; its own exact answer.
Point3 Warp(Point3 p) {
  return {1.2F * p.x + 0.3F * std::sin(p.y / 4), p.y - 0.02F * p.y * p.y, 0.9F * p.z + 0.1F * p.x};
}

TEST(GeometryMapping, FollowsASmoothWarpBetweenTheSamplesToo) {
  const auto source = Face();
  std::vector<Point3> target;
  for (const Point3 p : source) target.push_back(Warp(p));
  Context c;
  ASSERT_TRUE(c.Solve(source, target));
  // Motions of 1 cm in every direction; the mapped motion may be off by a fifth of it. Motion out
  // of the face is extrapolation, and only the alignment's.
  for (const Point3 p : source) {
    if (std::abs(p.x) == 6 || std::abs(p.y) == 8) continue;
    for (const Point3 motion : {Point3{1, 0, 0}, Point3{0, -1, 0}, Point3{0, 0, 0.5F}}) {
      const Point3 mapped = c.mapping.Motion(c.mapping.AnchorAt(p), p + motion);
      const Point3 exact = Warp(p + motion) - Warp(p);
      const Point3 error = mapped - exact;
      EXPECT_LT(std::sqrt(Dot(error, error)), 0.2F)
          << "at " << p.x << ", " << p.y << " moving " << motion.x << ", " << motion.y;
    }
  }
}

TEST(GeometryMapping, ALidThatReachesTheOtherLidLandsOnTheTargetsOtherLid) {
  auto source = Face();
  auto target = source;
  const Point3 upper{3, 3.5F, 4};
  const Point3 lower{3, 2.6F, 4};
  source.insert(source.end(), {upper, lower});
  target.insert(target.end(), {Point3{3, 4.0F, 4}, Point3{3, 2.2F, 4}});  // larger eyes
  Context c;
  ASSERT_TRUE(c.Solve(source, target));
  const Point3 closed = Point3{3, 4.0F, 4} + c.mapping.Motion(c.mapping.AnchorAt(upper), lower);
  EXPECT_NEAR(closed.y, 2.2F, 0.12F) << "the gap doubled, and nothing around it did";
}

TEST(GeometryMapping, LipsThatTouchDoNotTearSpaceApart) {
  auto source = Face();
  auto target = source;
  source.insert(source.end(), {Point3{0, -4.00F, 5}, Point3{0, -4.02F, 5}});
  target.insert(target.end(), {Point3{0, -3.9F, 5}, Point3{0, -4.1F, 5}});
  Context c;
  ASSERT_TRUE(c.Solve(source, target));
  const Point3 moved = c.mapping.Motion(c.mapping.AnchorAt({0, -4.02F, 5}), {0, -5.02F, 5});
  EXPECT_NEAR(moved.y, -1, 0.3F);
}

TEST(GeometryMapping, OnePointMovesAsThePerformerDoes) {
  Context c;
  ASSERT_TRUE(c.Solve({{1, 2, 3}}, {{0, 0, 0}}));
  const Point3 moved = c.mapping.Motion(c.mapping.AnchorAt({1, 2, 3}), {1, 1, 3});
  EXPECT_NEAR(moved.x, 0, 0.05);
  EXPECT_NEAR(moved.y, -1, 0.05);
}

TEST(GeometryMapping, MorePointsThanReservedAreRefused) {
  Context c;
  ASSERT_TRUE(c.Solve({{0, 0, 0}, {1, 0, 0}}, {{0, 0, 0}, {1, 0, 0}}));
  const std::vector<Point3> three = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  const std::vector<std::int16_t> landmarks(3, -1);
  EXPECT_EQ(c.mapping.Solve(three, three, landmarks, c.workspace).error(), Errc::kFull);
}

}  // namespace
}  // namespace facewire::retarget
