#include "core/pose/pose_estimator.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <set>

#include "core/pose/canonical_face.h"
#include "tests/support/allocation_counter.h"
#include "tests/support/generated_face.h"

namespace facewire::pose {
namespace {

using test::FacePoints;
using test::GeneratedFace;
using test::Photograph;
using test::Rotation;
using test::View;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

float LargestDifference(const FacePose& pose, const FacePoints& face) {
  float largest = 0;
  for (std::size_t i = 0; i < pose.count; ++i) {
    const Point3 d = pose.points_cm[i] - face[i];
    largest = std::max(largest, std::sqrt(Dot(d, d)));
  }
  return largest;
}

float LargestDifference(const Matrix3& a, const Matrix3& b) {
  float largest = 0;
  for (std::size_t i = 0; i < 9; ++i) largest = std::max(largest, std::abs(a[i] - b[i]));
  return largest;
}

Point3 CanonicalCentre() {
  Point3 sum{};
  float total = 0;
  for (const CanonicalPoint& p : kCanonicalFace) {
    sum = sum + p.weight * p.position_cm;
    total += p.weight;
  }
  return (1 / total) * sum;
}

// That centre seen in the middle of the picture: no slanted view to correct.
View CentredView(const Matrix3& rotation, float scale_px_per_cm) {
  const Point3 seen = scale_px_per_cm * (rotation * CanonicalCentre());
  return {rotation, scale_px_per_cm, {320 - seen.x, 240 + seen.y, seen.z}};
}

class PoseEstimatorTest : public testing::Test {
 protected:
  PoseConfig config_;
  FacePoints face_ = GeneratedFace();
  Result<FacePose> Call(const Landmarks& in) { return PoseEstimator(config_).Update(in); }
};

TEST_F(PoseEstimatorTest, AFaceThatLooksIntoTheCameraHasNoRotation) {
  const auto pose = Call(Photograph(face_, CentredView(kIdentity3, 7)));
  ASSERT_TRUE(pose);
  EXPECT_LT(LargestDifference(pose->camera_R_head, kIdentity3), 1e-5F);
  EXPECT_NEAR(pose->scale_px_per_cm, 7, 1e-4);
  EXPECT_LT(LargestDifference(*pose, face_), 1e-4F);
}

TEST_F(PoseEstimatorTest, RecoversEveryRotationExactly) {
  for (float pitch = -40; pitch <= 40; pitch += 20) {
    for (float yaw = -40; yaw <= 40; yaw += 20) {
      for (float roll = -40; roll <= 40; roll += 20) {
        const Matrix3 rotation = Rotation(pitch, yaw, roll);
        const auto pose = Call(Photograph(face_, CentredView(rotation, 9)));
        ASSERT_TRUE(pose);
        ASSERT_LT(LargestDifference(pose->camera_R_head, rotation), 2e-5F);
        const HeadAngles angles = AnglesOf(pose->camera_R_head);
        ASSERT_NEAR(angles.pitch_deg, pitch, 2e-3);
        ASSERT_NEAR(angles.yaw_deg, yaw, 2e-3);
        ASSERT_NEAR(angles.roll_deg, roll, 2e-3);
      }
    }
  }
}

TEST_F(PoseEstimatorTest, PointsInObjectSpaceDoNotMoveWithTheHead) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> angle(-40, 40);
  std::uniform_real_distribution<float> place(0, 400);
  std::uniform_real_distribution<float> scale(2, 30);
  for (int i = 0; i < 300; ++i) {
    const View view{Rotation(angle(random), angle(random), angle(random)),
                    scale(random),
                    {place(random), place(random), place(random)}};
    const auto pose = Call(Photograph(face_, view));
    ASSERT_TRUE(pose);
    ASSERT_LT(LargestDifference(*pose, face_), 1e-3F);
    ASSERT_NEAR(pose->scale_px_per_cm, view.scale_px_per_cm, 1e-3);
  }
}

TEST_F(PoseEstimatorTest, AnExpressionOutsideTheBasisDoesNotMoveTheHead) {
  const View view{Rotation(10, -20, 5), 7, {200, 300, 0}};
  const auto neutral = Call(Photograph(face_, view));
  FacePoints open = face_;
  for (std::size_t lip : {13, 14, 17, 152, 78, 308}) open[lip] = open[lip] + Point3{0, -2, -0.5F};
  const auto mouth_open = Call(Photograph(open, view));
  ASSERT_TRUE(neutral && mouth_open);
  EXPECT_EQ(mouth_open->camera_R_head, neutral->camera_R_head);
  EXPECT_EQ(mouth_open->camera_t_head_cm, neutral->camera_t_head_cm);
  EXPECT_LT(LargestDifference(*mouth_open, open), 1e-3F);
}

TEST_F(PoseEstimatorTest, DistanceFollowsFromTheFieldOfViewAndTheSize) {
  config_.vertical_fov_deg = 90;  // focal length = half the picture's height
  const auto pose = Call(Photograph(face_, CentredView(kIdentity3, 4)));
  ASSERT_TRUE(pose);
  // 4 px for a cm at a focal length of 240 px: 60 cm away, measured to the weighted centre of the
  // fit.
  EXPECT_NEAR(pose->camera_t_head_cm.z, -60 - CanonicalCentre().z, 1e-2);
}

TEST_F(PoseEstimatorTest, AHeadFurtherRightAndUpHasALargerXAndY) {
  View view = CentredView(kIdentity3, 4);
  const auto middle = Call(Photograph(face_, view));
  view.origin_px = view.origin_px + Point3{40, -20, 0};
  config_.vertical_fov_deg = 10;
  const auto moved = Call(Photograph(face_, view));
  ASSERT_TRUE(middle && moved);
  EXPECT_NEAR(moved->camera_t_head_cm.x - middle->camera_t_head_cm.x, 10, 0.1);
  EXPECT_NEAR(moved->camera_t_head_cm.y - middle->camera_t_head_cm.y, 5, 0.1);
}

TEST_F(PoseEstimatorTest, AFaceBesideTheMiddleIsSeenFromTheSide) {
  // It shows its front along a ray 45 degrees to the right: in the camera's axes it is turned, to
  // look back at the camera, to its own right.
  config_.vertical_fov_deg = 90;
  View view = CentredView(kIdentity3, 4);
  view.origin_px.x += 240;
  const auto pose = Call(Photograph(face_, view));
  ASSERT_TRUE(pose);
  EXPECT_NEAR(AnglesOf(pose->camera_R_head).yaw_deg, -45, 0.01);
  EXPECT_NEAR(AnglesOf(pose->camera_R_head).pitch_deg, 0, 0.01);
  EXPECT_LT(LargestDifference(*pose, face_), 1e-3F) << "object space does not care";
}

TEST_F(PoseEstimatorTest, APerspectivePictureGivesTheRotationBack) {
  // A real pinhole camera, off-axis: z as the networks give it, relative and in the picture's
  // scale.
  config_.vertical_fov_deg = 40;
  const float focal = 240 / std::tan(20 * std::numbers::pi_v<float> / 180);
  const Matrix3 rotation = Rotation(5, 15, -10);
  for (const Point3 at : {Point3{0, 0, -60}, Point3{15, 0, -60}, Point3{-12, 10, -60}}) {
    Landmarks picture = Photograph(face_, {});
    for (std::size_t i = 0; i < kMaxLandmarks; ++i) {
      const Point3 p = rotation * face_[i] + at;
      // Turned so that the face's ray is the axis, its depth is what a crop around the face shows.
      const Point3 ray = (1 / std::sqrt(Dot(at, at))) * at;
      const float depth = Dot(p, ray) - std::sqrt(Dot(at, at));
      picture.points_px[i] = {320 - focal * p.x / p.z, 240 + focal * p.y / p.z,
                              depth * focal / -at.z};
    }
    const auto pose = Call(picture);
    ASSERT_TRUE(pose);
    const HeadAngles angles = AnglesOf(pose->camera_R_head);
    EXPECT_NEAR(angles.pitch_deg, 5, 2.5);
    EXPECT_NEAR(angles.yaw_deg, 15, 2.5);
    EXPECT_NEAR(angles.roll_deg, -10, 2.5);
    EXPECT_NEAR(pose->camera_t_head_cm.x, at.x, 1);
    EXPECT_NEAR(pose->camera_t_head_cm.y, at.y, 1);
    EXPECT_NEAR(pose->camera_t_head_cm.z, at.z, 3);
  }
}

TEST_F(PoseEstimatorTest, DepthHasTheUnitOfWidthAndHeight) {
  // A face pressed flat, as if z had been left in another unit, is not taken for a face.
  FacePoints flat = face_;
  for (Point3& p : flat) p.z = 0;
  EXPECT_EQ(Call(Photograph(flat, {})).error(), Errc::kRejected);
  // A face 30 % deeper than the canonical one keeps its depth (its rotation is found a little less
  // well).
  FacePoints deep = face_;
  for (Point3& p : deep) p.z *= 1.3F;
  const auto pose = Call(Photograph(deep, CentredView(Rotation(0, 25, 0), 7)));
  ASSERT_TRUE(pose);
  const float depth = pose->points_cm[4].z - pose->points_cm[127].z;
  const float width = pose->points_cm[356].x - pose->points_cm[127].x;
  EXPECT_NEAR(depth / width, (deep[4].z - deep[127].z) / (deep[356].x - deep[127].x), 0.01);
}

TEST_F(PoseEstimatorTest, TheLightNetworksLandmarksDoAsWell) {
  Landmarks mesh = Photograph(face_, {});
  mesh.count = kMeshLandmarks;
  const auto pose = Call(mesh);
  ASSERT_TRUE(pose);
  EXPECT_EQ(pose->count, kMeshLandmarks);
}

TEST_F(PoseEstimatorTest, SequenceTimeAndPresencePassThrough) {
  Landmarks in = Photograph(face_, {});
  in.seq = 77;
  in.captured = Time(std::chrono::milliseconds(5));
  in.presence = 0.75F;
  const auto pose = Call(in);
  ASSERT_TRUE(pose);
  EXPECT_EQ(pose->seq, 77U);
  EXPECT_EQ(pose->captured, in.captured);
  EXPECT_EQ(pose->presence, 0.75F);
}

TEST_F(PoseEstimatorTest, WhatIsNoFaceIsRejected) {
  const Landmarks good = Photograph(face_, {});
  const auto rejects = [&](auto change) {
    Landmarks bad = good;
    change(bad);
    const auto pose = Call(bad);
    return !pose && pose.error() == Errc::kRejected;
  };
  EXPECT_TRUE(rejects([](Landmarks& l) { l.points_px[4].x = kNan; }));
  EXPECT_TRUE(rejects([](Landmarks& l) { l.points_px[477].z = INFINITY; })) << "outside the basis";
  EXPECT_TRUE(rejects([](Landmarks& l) { l.points_px[4].y = 1e30F; }));
  EXPECT_TRUE(rejects([](Landmarks& l) { l.points_px.fill({5, 5, 5}); })) << "all in one place";
  EXPECT_TRUE(rejects([](Landmarks& l) { l.points_px.fill({}); }));
  EXPECT_TRUE(rejects([](Landmarks& l) {
    for (Point3& p : l.points_px) p = {p.x, p.x, p.x};
  })) << "on a line";
  EXPECT_TRUE(rejects([](Landmarks& l) {
    for (Point3& p : l.points_px) p.x = 640 - p.x;
  })) << "mirrored";
  EXPECT_TRUE(rejects([](Landmarks& l) {
    for (Point3& p : l.points_px) p.z = -p.z;
  })) << "inside out";
  EXPECT_TRUE(rejects([](Landmarks& l) {
    std::shuffle(l.points_px.begin(), l.points_px.end(), std::mt19937(1));
  })) << "scrambled";
  EXPECT_TRUE(rejects([](Landmarks& l) { l.count = 0; }));
  EXPECT_TRUE(rejects([](Landmarks& l) { l.count = 477; }));
  EXPECT_TRUE(rejects([](Landmarks& l) { l.height_px = 0; }));
}

TEST_F(PoseEstimatorTest, WhateverComesInARotationComesOut) {
  std::mt19937 random(11);
  std::normal_distribution<float> noise;
  std::uniform_real_distribution<float> exponent(-3, 1);
  config_.max_misfit = 1;  // take everything
  int accepted = 0;
  for (int i = 0; i < 500; ++i) {
    Landmarks in =
        Photograph(face_, {Rotation(50 * noise(random), 90 * noise(random), 90 * noise(random))});
    const float amount = 100 * std::pow(10.F, exponent(random));
    for (Point3& p : in.points_px) {
      p = p + amount * Point3{noise(random), noise(random), noise(random)};
    }
    const auto pose = Call(in);
    if (!pose) continue;
    ++accepted;
    const Matrix3& r = pose->camera_R_head;
    for (std::size_t a = 0; a < 3; ++a) {
      for (std::size_t b = a; b < 3; ++b) {
        const float dot =
            r[3 * a] * r[3 * b] + r[3 * a + 1] * r[3 * b + 1] + r[3 * a + 2] * r[3 * b + 2];
        ASSERT_NEAR(dot, a == b ? 1 : 0, 1e-5);
      }
    }
    const float determinant = r[0] * (r[4] * r[8] - r[5] * r[7]) -
                              r[1] * (r[3] * r[8] - r[5] * r[6]) +
                              r[2] * (r[3] * r[7] - r[4] * r[6]);
    ASSERT_NEAR(determinant, 1, 1e-5);
    ASSERT_GT(pose->scale_px_per_cm, 0);
  }
  EXPECT_GT(accepted, 400);
}

TEST_F(PoseEstimatorTest, GarbageIsRejectedOrGivesFiniteNumbers) {
  std::mt19937 random(12);
  config_.max_misfit = 1;
  for (int i = 0; i < 2000; ++i) {
    Landmarks in = Photograph(face_, {});
    // Any bits at all, made finite now and then.
    for (Point3& p : in.points_px) {
      for (float* v : {&p.x, &p.y, &p.z}) {
        const float any = std::ldexp(1.F, static_cast<int>(random() % 300) - 150);
        *v = (random() % 2 != 0) ? any : -any;
        if (random() % 100 != 0) *v = std::fmod(*v, 1e5F);
      }
    }
    const auto pose = Call(in);
    if (!pose) continue;
    for (const Point3& p : pose->points_cm) ASSERT_TRUE(std::isfinite(p.x + p.y + p.z));
    for (float v : pose->camera_R_head) ASSERT_TRUE(std::isfinite(v));
  }
}

TEST(PoseConfigTest, IsChecked) {
  EXPECT_TRUE(Validate(PoseConfig{}));
  EXPECT_TRUE(Validate(PoseConfig{.vertical_fov_deg = 5, .max_misfit = 1}));
  for (float fov : {0.F, 4.9F, 151.F, kNan, -63.F}) {
    EXPECT_EQ(Validate(PoseConfig{.vertical_fov_deg = fov}).error(), Errc::kOutOfRange);
  }
  for (float misfit : {-0.1F, 1.1F, kNan}) {
    EXPECT_EQ(Validate(PoseConfig{.max_misfit = misfit}).error(), Errc::kOutOfRange);
  }
}

TEST(CanonicalFaceTest, NamesEveryMeshLandmarkOnceAndIsAsSymmetricAsAFace) {
  std::set<int> seen;
  for (const CanonicalPoint& p : kCanonicalFace) {
    EXPECT_LT(p.landmark, kMeshLandmarks);
    EXPECT_TRUE(seen.insert(p.landmark).second);
    EXPECT_GT(p.weight, 0);
  }
  EXPECT_NEAR(CanonicalCentre().x, 0, 0.2);
}

TEST(PoseEstimatorMemory, UpdateAllocatesNothing) {
  if (!test::AllocationCounter::kAvailable) GTEST_SKIP() << test::AllocationCounter::kWhyNot;
  const Landmarks in = Photograph(GeneratedFace(), {});
  const PoseEstimator estimator{PoseConfig{}};
  test::AllocationCounter counter;
  counter.Arm();
  const bool found = estimator.Update(in).has_value();
  counter.Disarm();
  EXPECT_TRUE(found);
  EXPECT_EQ(counter.allocations(), 0U);
  EXPECT_EQ(counter.frees(), 0U);
}

}  // namespace
}  // namespace facewire::pose
