#include "tools/sheet/character.h"

#include <gtest/gtest.h>

#include "tests/tools/sheet/rigs.h"

namespace facewire::tools {
namespace {

TEST(Character, IsNeutralWhenTheRigIs) {
  const Rig rig = BoneRig();
  const CharacterPose pose = CharacterPoseOf(rig, rig.NeutralPose());
  EXPECT_EQ(pose.jaw, 0);
  EXPECT_EQ(pose.lid_left, 0);
  EXPECT_EQ(pose.yaw_deg, 0);
}

TEST(Character, ShowsTheBonesInPartsOfTheirRange) {
  const Rig rig = BoneRig();
  RigPose pose = rig.NeutralPose();
  Set(rig, pose, "jaw.pitch", 12);
  Set(rig, pose, "upper_lid_R.pitch", 45);
  Set(rig, pose, "lip_corner_L.y", -1.6F);
  Set(rig, pose, "neck.yaw", 20);
  const CharacterPose character = CharacterPoseOf(rig, pose);
  EXPECT_NEAR(character.jaw, 0.5, 1e-6);
  EXPECT_NEAR(character.lid_right, 1, 1e-6);
  EXPECT_EQ(character.lid_left, 0);
  EXPECT_NEAR(character.corner_left_y, -1, 1e-6);
  EXPECT_NEAR(character.yaw_deg, 20, 1e-6);
}

TEST(Character, PrefersBonesToBlendShapesAndTakesBlendShapesWithoutBones) {
  const Rig with_bones = BoneRig();
  RigPose pose = with_bones.NeutralPose();
  Set(with_bones, pose, "jawOpen", 1);
  EXPECT_EQ(CharacterPoseOf(with_bones, pose).jaw, 0);

  Rig shapes;
  AddChannel(shapes, "jawOpen", ChannelKind::kParameter, 0, 1);
  RigPose open = shapes.NeutralPose();
  Set(shapes, open, "jawOpen", 0.7F);
  EXPECT_NEAR(CharacterPoseOf(shapes, open).jaw, 0.7, 1e-6);
}

TEST(Character, LooksDifferentWithTheMouthOpenAndStaysInItsBox) {
  Canvas shut(200, 200, palette::kCard);
  Canvas open(200, 200, palette::kCard);
  CharacterPose pose;
  DrawCharacter(pose, {50, 50, 100, 100}, shut);
  pose.jaw = 1;
  DrawCharacter(pose, {50, 50, 100, 100}, open);
  cv::Mat difference;
  cv::absdiff(shut.Finish(), open.Finish(), difference);
  EXPECT_GT(cv::countNonZero(difference.reshape(1)), 100);
  EXPECT_EQ(cv::countNonZero(difference.rowRange(0, 50).reshape(1)), 0);
  EXPECT_EQ(cv::countNonZero(difference.rowRange(150, 200).reshape(1)), 0);
}

}  // namespace
}  // namespace facewire::tools
