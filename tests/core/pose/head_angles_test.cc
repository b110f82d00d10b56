#include <gtest/gtest.h>

#include <cmath>

#include "core/face_pose.h"
#include "tests/support/generated_face.h"

namespace facewire {
namespace {

using test::Rotation;

TEST(AnglesOf, PositiveYawTurnsTheFaceToThePersonsLeft) {
  const Matrix3 r = Rotation(0, 30, 0);
  EXPECT_GT((r * Point3{0, 0, 1}).x, 0) << "+x is the person's left";
  EXPECT_NEAR(AnglesOf(r).yaw_deg, 30, 1e-4);
}

TEST(AnglesOf, PositivePitchNodsTheFaceDown) {
  const Matrix3 r = Rotation(20, 0, 0);
  EXPECT_LT((r * Point3{0, 0, 1}).y, 0);
  EXPECT_NEAR(AnglesOf(r).pitch_deg, 20, 1e-4);
}

TEST(AnglesOf, PositiveRollTiltsTheTopToThePersonsRight) {
  const Matrix3 r = Rotation(0, 0, 10);
  EXPECT_LT((r * Point3{0, 1, 0}).x, 0);
  EXPECT_NEAR(AnglesOf(r).roll_deg, 10, 1e-4);
}

TEST(AnglesOf, AllAnglesComeBackFromTheMatrix) {
  for (float pitch = -85; pitch <= 85; pitch += 17) {
    for (float yaw = -175; yaw <= 175; yaw += 35) {
      for (float roll = -175; roll <= 175; roll += 35) {
        const HeadAngles angles = AnglesOf(Rotation(pitch, yaw, roll));
        ASSERT_NEAR(angles.pitch_deg, pitch, 2e-3);
        ASSERT_NEAR(angles.yaw_deg, yaw, 2e-3);
        ASSERT_NEAR(angles.roll_deg, roll, 2e-3);
      }
    }
  }
}

TEST(AnglesOf, LookingStraightDownTheAnglesStillDescribeTheMatrix) {
  for (float pitch : {90.F, -90.F}) {
    const Matrix3 r = Rotation(pitch, 30, 10);
    const HeadAngles angles = AnglesOf(r);
    const Matrix3 again = Rotation(angles.pitch_deg, angles.yaw_deg, angles.roll_deg);
    for (std::size_t i = 0; i < 9; ++i) EXPECT_NEAR(again[i], r[i], 2e-3);
    EXPECT_EQ(angles.roll_deg, 0);
  }
}

TEST(AnglesOf, RoundingBeyondOneIsNoNan) {
  Matrix3 r = Rotation(90, 0, 0);
  r[5] = -1.0000002F;
  EXPECT_NEAR(AnglesOf(r).pitch_deg, 90, 0.1);
}

}  // namespace
}  // namespace facewire
