#include "tools/gltf/face_mesh.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

namespace facewire::tools {
namespace {

constexpr std::array kArkitShapes{
    "browDownLeft",      "browDownRight",      "browInnerUp",         "browOuterUpLeft",
    "browOuterUpRight",  "cheekPuff",          "cheekSquintLeft",     "cheekSquintRight",
    "eyeBlinkLeft",      "eyeBlinkRight",      "eyeLookDownLeft",     "eyeLookDownRight",
    "eyeLookInLeft",     "eyeLookInRight",     "eyeLookOutLeft",      "eyeLookOutRight",
    "eyeLookUpLeft",     "eyeLookUpRight",     "eyeSquintLeft",       "eyeSquintRight",
    "eyeWideLeft",       "eyeWideRight",       "jawForward",          "jawLeft",
    "jawOpen",           "jawRight",           "mouthClose",          "mouthDimpleLeft",
    "mouthDimpleRight",  "mouthFrownLeft",     "mouthFrownRight",     "mouthFunnel",
    "mouthLeft",         "mouthLowerDownLeft", "mouthLowerDownRight", "mouthPressLeft",
    "mouthPressRight",   "mouthPucker",        "mouthRight",          "mouthRollLower",
    "mouthRollUpper",    "mouthShrugLower",    "mouthShrugUpper",     "mouthSmileLeft",
    "mouthSmileRight",   "mouthStretchLeft",   "mouthStretchRight",   "mouthUpperUpLeft",
    "mouthUpperUpRight", "noseSneerLeft",      "noseSneerRight"};

float Length(Point3 v) { return std::sqrt(Dot(v, v)); }

std::vector<FacePoint> Points(FaceMaterial material) {
  return MakeFaceMesh()[static_cast<std::size_t>(material)].points;
}

// Of all points of the mask, how far the one goes that goes furthest.
float Furthest(std::string_view shape) {
  float furthest = 0;
  for (const FacePart& part : MakeFaceMesh())
    for (const FacePoint& point : part.points)
      furthest = std::max(furthest, Length(Displacement(point, shape)));
  return furthest;
}

TEST(FaceMesh, ShowsEveryShapeThatLandmarksCanShow) {
  for (const char* shape : kArkitShapes) {
    EXPECT_GT(Furthest(shape), 0.1F) << shape;
    EXPECT_LT(Furthest(shape), 3.5F) << shape;
  }
}

TEST(FaceMesh, StaysStillForWhatItHasNoMovementFor) {
  for (const char* shape : {"", "Left", "tongueOut", "jaw", "jawOpenLeft", "eyeBlink", "wetness"})
    EXPECT_EQ(Furthest(shape), 0) << shape;
}

TEST(FaceMesh, PartsAreTrianglesOfTheirOwnPoints) {
  const auto parts = MakeFaceMesh();
  ASSERT_EQ(parts.size(), kFaceMaterials);
  for (const FacePart& part : parts) {
    EXPECT_FALSE(part.triangles.empty());
    EXPECT_EQ(part.triangles.size() % 3, 0U);
    for (const auto index : part.triangles) EXPECT_LT(index, part.points.size());
    for (const FacePoint& point : part.points) {
      EXPECT_NEAR(Length(point.normal), 1, 1e-5);
      EXPECT_TRUE(IsWithin(point.rest_cm, 12));
    }
  }
}

TEST(FaceMesh, LooksToThePositiveZ) {
  for (const FacePart& part : MakeFaceMesh()) {
    for (std::size_t t = 0; t < part.triangles.size(); t += 3) {
      const Point3 a = part.points[part.triangles[t]].rest_cm;
      const Point3 u = part.points[part.triangles[t + 1]].rest_cm - a;
      const Point3 v = part.points[part.triangles[t + 2]].rest_cm - a;
      const Point3 area{u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x};
      EXPECT_GT(Length(area), 1e-5F) << "a triangle without an area";
      if (part.material == FaceMaterial::kSkin) {
        EXPECT_GT(area.z, 0);
      }
    }
  }
}

TEST(FaceMesh, ABlinkShutsItsOwnEyeToALine) {
  int lids = 0;
  for (const FacePoint& point : Points(FaceMaterial::kSkin)) {
    const Point3 left = Displacement(point, "eyeBlinkLeft");
    const Point3 right = Displacement(point, "eyeBlinkRight");
    EXPECT_EQ(left.y, point.rest_cm.x > 0 ? -point.lid_cm : 0);
    EXPECT_EQ(right.y, point.rest_cm.x < 0 ? -point.lid_cm : 0);
    lids += std::abs(point.lid_cm) > 0.1F ? 1 : 0;
  }
  EXPECT_GT(lids, 20);
}

TEST(FaceMesh, AnOpenJawPartsTheLipsAndLeavesTheForehead) {
  float upper = std::numeric_limits<float>::max();
  float lower = 0;
  for (const FacePoint& point : Points(FaceMaterial::kLip)) {
    if (std::abs(point.rest_cm.x) > 0.1F || point.rest_cm.y != -4.3F) continue;
    const float dy = Displacement(point, "jawOpen").y;
    upper = std::min(upper, std::abs(dy));
    lower = std::min(lower, dy);
  }
  EXPECT_EQ(upper, 0);
  EXPECT_LT(lower, -1);
  for (const FacePoint& point : Points(FaceMaterial::kSkin)) {
    if (point.rest_cm.y > 0) {
      EXPECT_EQ(Displacement(point, "jawOpen"), Point3{});
    }
  }
}

TEST(FaceMesh, AnEyeTurnsTheWayOfItsName) {
  for (const FacePoint& point : Points(FaceMaterial::kIris)) {
    const auto side = static_cast<float>(point.eye);
    const char* const out = point.eye > 0 ? "eyeLookOutLeft" : "eyeLookOutRight";
    const char* const others = point.eye > 0 ? "eyeLookOutRight" : "eyeLookOutLeft";
    const char* const up = point.eye > 0 ? "eyeLookUpLeft" : "eyeLookUpRight";
    EXPECT_GT(side * Displacement(point, out).x, 0.1F);
    EXPECT_EQ(Displacement(point, others), Point3{});
    EXPECT_GT(Displacement(point, up).y, 0.1F);
  }
}

TEST(FaceMesh, TheTwoSidesMirrorEachOther) {
  for (FacePoint point : Points(FaceMaterial::kSkin)) {
    const Point3 left = Displacement(point, "mouthSmileLeft");
    point.rest_cm.x = -point.rest_cm.x;
    const Point3 right = Displacement(point, "mouthSmileRight");
    EXPECT_NEAR(left.x, -right.x, 1e-5);
    EXPECT_NEAR(left.y, right.y, 1e-5);
  }
}

}  // namespace
}  // namespace facewire::tools
