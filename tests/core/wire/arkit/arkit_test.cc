#include "core/wire/arkit/arkit.h"

#include <gtest/gtest.h>

#include <string>

namespace facewire::wire::arkit {
namespace {

struct Context {
  Rig rig;
  RigPose pose;

  int Bone(const char* name) {
    EXPECT_TRUE(rig.bones.try_push({.name = *ShortName::From(name)}));
    return static_cast<int>(rig.bones.size()) - 1;
  }
  // A channel, and its value in the pose.
  void Add(const char* name, float value, float max = 1, ChannelKind kind = ChannelKind::kParameter,
           int bone = -1) {
    Channel c;
    c.name = *ShortName::From(name);
    c.kind = kind;
    c.bone = static_cast<std::int16_t>(bone);
    c.min = kind == ChannelKind::kParameter ? 0.0F : -max;
    c.max = max;
    EXPECT_TRUE(rig.channels.try_push(c));
    pose.values[pose.count++] = value;
  }
  void Turn(const char* bone, float pitch, float yaw, float roll) {
    const int b = Bone(bone);
    Add("p", pitch, 90, ChannelKind::kPitch, b);
    Add("y", yaw, 90, ChannelKind::kYaw, b);
    Add("r", roll, 90, ChannelKind::kRoll, b);
  }
  Face FaceOf() const { return FaceMap(rig).FaceOf(pose); }
};

void ExpectAngles(const HeadAngles& is, float pitch, float yaw, float roll) {
  EXPECT_NEAR(is.pitch_deg, pitch, 1e-3F);
  EXPECT_NEAR(is.yaw_deg, yaw, 1e-3F);
  EXPECT_NEAR(is.roll_deg, roll, 1e-3F);
}

TEST(ArkitShapes, StandInLiveLinksOrder) {
  EXPECT_EQ(kShapeNames[0], "eyeBlinkLeft");
  EXPECT_EQ(kShapeNames[7], "eyeBlinkRight");
  EXPECT_EQ(kShapeNames[14], "jawForward");
  EXPECT_EQ(kShapeNames[15], "jawLeft");
  EXPECT_EQ(kShapeNames[17], "jawOpen");
  EXPECT_EQ(kShapeNames[23], "mouthSmileLeft");
  EXPECT_EQ(kShapeNames[41], "browDownLeft");
  EXPECT_EQ(kShapeNames[43], "browInnerUp");
  EXPECT_EQ(kShapeNames[46], "cheekPuff");
  EXPECT_EQ(kShapeNames[51], "tongueOut");
  for (std::size_t i = 0; i < kShapes; ++i) EXPECT_EQ(FindShape(kShapeNames[i]), i);
}

TEST(ArkitShapes, AreFoundHoweverTheyAreWritten) {
  for (const char* name : {"mouthSmileLeft", "MouthSmileLeft", "mouthSmile_L", "mouth_smile.l",
                           "MOUTHSMILE-LEFT", "mouthSmile_Left"}) {
    EXPECT_EQ(FindShape(name), 23U) << name;
  }
  EXPECT_EQ(FindShape("jaw_R"), 16U);
  EXPECT_EQ(FindShape("mouthSmile"), std::nullopt);
  EXPECT_EQ(FindShape("_neutral"), std::nullopt);
  EXPECT_EQ(FindShape("_L"), std::nullopt);
  EXPECT_EQ(FindShape(""), std::nullopt);
}

TEST(FaceMap, TakesParametersByNameAndLeavesTheRestAtZero) {
  Context c;
  c.Add("wagTail", 0.9F);
  c.Add("jawOpen", 0.25F);
  c.Add("browInnerUp", 1.25F, 1.5F);
  const FaceMap map(c.rig);
  EXPECT_TRUE(map.HasShape(17));
  EXPECT_FALSE(map.HasShape(51));
  EXPECT_FALSE(map.HasHead());
  EXPECT_FALSE(map.HasLeftEye());
  const Face face = map.FaceOf(c.pose);
  EXPECT_EQ(face.shapes[17], 0.25F);
  for (std::size_t i = 0; i < kShapes; ++i) {
    if (i != 17 && i != 43) {
      EXPECT_EQ(face.shapes[i], 0.0F) << kShapeNames[i];
    }
  }
}

TEST(FaceMap, ScalesAShapeThatCountsBeyondOne) {
  Context c;
  c.Add("jawOpen", 30, 120);
  c.rig.channels[0].neutral = 20;
  c.Add("mouthClose", 0.8F, 0.8F);  // a part of 1 that the rig may not exceed
  c.Add("tongueOut", -0.5F);
  EXPECT_FLOAT_EQ(c.FaceOf().shapes[17], 0.1F);
  EXPECT_EQ(c.FaceOf().shapes[18], 0.8F);
  EXPECT_EQ(c.FaceOf().shapes[51], 0.0F);
}

TEST(FaceMap, FindsTheTurnsOfBonesWhateverTheirStyle) {
  for (const auto& [left, right] : {std::pair{"eye_L", "eye_R"}, std::pair{"LeftEye", "RightEye"},
                                    std::pair{"Eye.l", "Eye.r"}}) {
    Context c;
    c.Turn(left, 1, 2, 3);
    c.Turn(right, 4, 5, 6);
    c.Turn("Neck", 7, 8, 9);
    c.Turn("jaw", 10, 11, 12);
    const Face face = c.FaceOf();
    ExpectAngles(face.left_eye, 1, 2, 3);
    ExpectAngles(face.right_eye, 4, 5, 6);
    ExpectAngles(HeadOf(face), 7, 8, 9);
    EXPECT_TRUE(FaceMap(c.rig).HasRightEye());
  }
}

TEST(FaceMap, AChannelOfABoneThatIsNotThereIsIgnored) {
  Context c;
  c.Add("lost", 1, 90, ChannelKind::kYaw, 5);
  EXPECT_FALSE(FaceMap(c.rig).HasHead());
}

TEST(HeadOf, IsNeckAndHeadOneUponTheOther) {
  Face face;
  face.neck = {.yaw_deg = 20};
  face.head = {.yaw_deg = 15};
  ExpectAngles(HeadOf(face), 0, 35, 0);
  face.neck = {.pitch_deg = 10};
  face.head = {.pitch_deg = -30};
  ExpectAngles(HeadOf(face), -20, 0, 0);
  // A head that nods on a neck that is turned by a quarter still nods.
  face.neck = {.yaw_deg = 90};
  face.head = {.pitch_deg = 25};
  ExpectAngles(HeadOf(face), 25, 90, 0);
  // And one that turns on a neck tilted by a quarter to the right looks down or up: its left is up.
  face.neck = {.roll_deg = 90};
  face.head = {.yaw_deg = 30};
  ExpectAngles(HeadOf(face), -30, 0, 90);
}

}  // namespace
}  // namespace facewire::wire::arkit
