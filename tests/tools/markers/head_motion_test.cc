#include "tools/markers/head_motion.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "app/error.h"
#include "tests/support/generated_face.h"

namespace facewire::tools::markers {
namespace {

const std::vector<Point3> kAtRest = {{0, 10, 4}, {4, 8, 2}, {-4, 8, 2}, {0, 6, 8}, {0, 0, 5}};
const std::vector<std::size_t> kRigid = {0, 1, 2, 3};

std::vector<Point3> Moved(const std::vector<Point3>& points, const Matrix3& rotation,
                          Point3 translation) {
  std::vector<Point3> moved;
  for (const Point3 p : points) moved.push_back(rotation * p + translation);
  return moved;
}

TEST(HeadMotion, IsWhatTookTheRigidMarkersAway) {
  HeadMotion motion(kRigid, "take");
  ASSERT_TRUE(motion.Find(kAtRest));
  auto open = kAtRest;
  open[4].y -= 2;  // the chin
  const auto head = motion.Find(Moved(open, test::Rotation(10, -25, 5), {3, -1, 40}));
  ASSERT_TRUE(head);
  const Point3 chin = head->ToHead(Moved(open, test::Rotation(10, -25, 5), {3, -1, 40})[4]);
  EXPECT_NEAR(chin.x, 0, 1e-4);
  EXPECT_NEAR(chin.y, -2, 1e-4);
  EXPECT_NEAR(chin.z, 5, 1e-4);
  EXPECT_LT(motion.misfit_cm(), 1e-4);
}

TEST(HeadMotion, IsUnknownWhileARigidMarkerIsNotSeen) {
  HeadMotion motion(kRigid, "take");
  auto gap = kAtRest;
  gap[2] = {NAN, NAN, NAN};
  EXPECT_FALSE(motion.Find(gap));
  EXPECT_TRUE(motion.Find(kAtRest));
}

TEST(HeadMotion, SaysHowRigidTheMarkersAre) {
  HeadMotion motion(kRigid, "take");
  (void)motion.Find(kAtRest);
  auto frown = kAtRest;
  frown[0].y += 1;
  (void)motion.Find(frown);
  EXPECT_GT(motion.misfit_cm(), 0.1);
}

TEST(HeadMotion, IsNoneWithoutRigidMarkers) {
  HeadMotion motion({}, "take");
  EXPECT_EQ(motion.Find(kAtRest)->ToHead({1, 2, 3}), (Point3{1, 2, 3}));
}

TEST(HeadMotion, NeedsMarkersThatAreNotOnOneLine) {
  HeadMotion motion({0, 1}, "take.trc");
  try {
    (void)motion.Find(kAtRest);
    ADD_FAILURE() << "two markers have no attitude";
  } catch (const app::BadInput& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("take.trc: --rigid needs three markers"));
  }
}

}  // namespace
}  // namespace facewire::tools::markers
