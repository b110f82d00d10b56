#include "tools/gltf/animation.h"

#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <assimp/Importer.hpp>
#include <cmath>
#include <cstring>
#include <limits>
#include <string_view>

namespace facewire::tools {
namespace {

using Head = std::array<float, 6>;

void AddBone(Rig& rig, std::string_view name, Point3 rest_cm) {
  Bone bone;
  bone.name = *ShortName::From(name);
  bone.rest_cm = rest_cm;
  ASSERT_TRUE(rig.bones.try_push(bone));
}

Channel& AddChannel(Rig& rig, std::string_view name, ChannelKind kind, std::int16_t bone, float min,
                    float max) {
  Channel channel;
  channel.name = *ShortName::From(name);
  channel.kind = kind;
  channel.bone = bone;
  channel.min = min;
  channel.max = max;
  EXPECT_TRUE(rig.channels.try_push(channel));
  return rig.channels[rig.channels.size() - 1];
}

// A jaw that turns about every axis and moves, a neck that the head drives, an eye without
// channels; a blend shape, and an angle.
Rig MakeRig() {
  Rig rig;
  rig.name = *ShortName::From("mini");
  AddBone(rig, "jaw", {0, -9, 4});
  AddBone(rig, "neck", {0, -12, -4});
  AddBone(rig, "eye", {3, 3, 3});
  AddChannel(rig, "jaw.pitch", ChannelKind::kPitch, 0, -90, 90);
  AddChannel(rig, "jaw.yaw", ChannelKind::kYaw, 0, -90, 90);
  AddChannel(rig, "jaw.roll", ChannelKind::kRoll, 0, -90, 90);
  AddChannel(rig, "jaw.z", ChannelKind::kPositionZ, 0, -1, 1);
  AddChannel(rig, "jawOpen", ChannelKind::kParameter, -1, 0, 1).neutral = 0.25F;
  Channel& neck = AddChannel(rig, "neck.yaw", ChannelKind::kYaw, 1, -60, 60);
  EXPECT_TRUE(neck.drives.try_push({*ShortName::From("head.yaw"), 1}));
  AddChannel(rig, "jaw_deg", ChannelKind::kParameter, -1, -10, 30);
  return rig;
}

RigPose Pose(const Rig& rig, std::initializer_list<std::pair<std::string_view, float>> values) {
  RigPose pose = rig.NeutralPose();
  for (const auto& [name, value] : values) pose.values[*rig.FindChannel(name)] = value;
  return pose;
}

// What another program's reader finds in the file.
class Read {
 public:
  explicit Read(const std::string& glb) {
    scene_ = importer_.ReadFileFromMemory(glb.data(), glb.size(), aiProcess_ValidateDataStructure,
                                          "glb");
    EXPECT_NE(scene_, nullptr) << importer_.GetErrorString();
  }
  const aiScene& scene() const { return *scene_; }
  const aiNode& node(const char* name) const { return *scene_->mRootNode->FindNode(name); }

  const aiNodeAnim* moves(std::string_view name) const {
    const aiAnimation& animation = *scene_->mAnimations[0];
    for (unsigned i = 0; i < animation.mNumChannels; ++i)
      if (name == animation.mChannels[i]->mNodeName.C_Str()) return animation.mChannels[i];
    return nullptr;
  }
  const aiMeshMorphAnim& morphs() const { return *scene_->mAnimations[0]->mMorphMeshChannels[0]; }
  // Seconds of a key of assimp's milliseconds.
  static double Seconds(double ticks) { return ticks / 1000; }

 private:
  Assimp::Importer importer_;
  const aiScene* scene_ = nullptr;
};

// R = Ry(yaw) Rx(pitch) Rz(roll) of core/rig/rig.h, by assimp's own matrices.
aiMatrix3x3 Rotation(float pitch_deg, float yaw_deg, float roll_deg) {
  aiMatrix4x4 y, x, z;
  const float rad = std::acos(-1.0F) / 180;
  aiMatrix4x4::RotationY(yaw_deg * rad, y);
  aiMatrix4x4::RotationX(pitch_deg * rad, x);
  aiMatrix4x4::RotationZ(roll_deg * rad, z);
  return aiMatrix3x3(y * x * z);
}

void ExpectSame(const aiMatrix3x3& a, const aiMatrix3x3& b) {
  for (unsigned r = 0; r < 3; ++r)
    for (unsigned c = 0; c < 3; ++c) EXPECT_NEAR(a[r][c], b[r][c], 1e-5) << r << " " << c;
}

TEST(GltfAnimation, HasANodeForEveryBoneAtItsRestInMetres) {
  const Rig rig = MakeRig();
  const Read read(GltfAnimation(rig).Encode("take"));
  const aiMatrix4x4& jaw = read.node("jaw").mTransformation;
  EXPECT_NEAR(jaw.b4, -0.09, 1e-6);
  EXPECT_NEAR(jaw.c4, 0.04, 1e-6);
  EXPECT_STREQ(read.node("jaw").mParent->mName.C_Str(), "head");
  EXPECT_STREQ(read.node("eye").mParent->mName.C_Str(), "head");
  EXPECT_STREQ(read.node("head").mParent->mName.C_Str(), "mini");
}

TEST(GltfAnimation, ABoneThatCarriesTheHeadDoesNotTurnTwice) {
  const Rig rig = MakeRig();
  const Read read(GltfAnimation(rig).Encode("take"));
  EXPECT_STREQ(read.node("neck").mParent->mName.C_Str(), "mini");
}

TEST(GltfAnimation, KeepsThePerformancesOwnTimes) {
  const Rig rig = MakeRig();
  GltfAnimation animation(rig);
  for (const std::int64_t t_us : std::array<std::int64_t, 4>{0, 10000, 50000, 3600000000})
    animation.Add(t_us, Head{}, Pose(rig, {}));
  const Read read(animation.Encode("take"));
  ASSERT_EQ(read.moves("jaw")->mNumRotationKeys, 4U);
  EXPECT_NEAR(Read::Seconds(read.moves("jaw")->mRotationKeys[1].mTime), 0.01, 1e-6);
  EXPECT_NEAR(Read::Seconds(read.moves("jaw")->mRotationKeys[2].mTime), 0.05, 1e-6);
  EXPECT_NEAR(Read::Seconds(read.morphs().mKeys[3].mTime), 3600, 1e-3);
}

TEST(GltfAnimation, LeavesAFrameOutThatIsNotLaterThanTheOneBefore) {
  const Rig rig = MakeRig();
  GltfAnimation animation(rig);
  for (const std::int64_t t_us : {0, 0, 20000, 10000}) animation.Add(t_us, Head{}, Pose(rig, {}));
  animation.AddLost(20000);
  EXPECT_EQ(animation.frames(), 2U);
}

TEST(GltfAnimation, TurnsABoneAsTheRigSays) {
  const Rig rig = MakeRig();
  GltfAnimation animation(rig);
  animation.Add(0, Head{}, Pose(rig, {{"jaw.pitch", 30}, {"jaw.yaw", -50}, {"jaw.roll", 70}}));
  animation.Add(1000, Head{}, Pose(rig, {{"jaw.pitch", -20}, {"jaw.z", 0.5F}}));
  const Read read(animation.Encode("take"));
  const aiNodeAnim& jaw = *read.moves("jaw");
  ExpectSame(jaw.mRotationKeys[0].mValue.GetMatrix(), Rotation(30, -50, 70));
  ExpectSame(jaw.mRotationKeys[1].mValue.GetMatrix(), Rotation(-20, 0, 0));
  EXPECT_NEAR(jaw.mPositionKeys[1].mValue.y, -0.09, 1e-6);
  EXPECT_NEAR(jaw.mPositionKeys[1].mValue.z, 0.045, 1e-6);
}

TEST(GltfAnimation, MovesTheHeadAboveTheBones) {
  const Rig rig = MakeRig();
  GltfAnimation animation(rig);
  animation.Add(0, Head{10, 20, -30, 1, 2, 3}, Pose(rig, {}));
  const Read read(animation.Encode("take"));
  const aiNodeAnim& head = *read.moves("head");
  ExpectSame(head.mRotationKeys[0].mValue.GetMatrix(), Rotation(10, 20, -30));
  EXPECT_NEAR(head.mPositionKeys[0].mValue.x, 0.01, 1e-6);
  EXPECT_NEAR(head.mPositionKeys[0].mValue.z, 0.03, 1e-6);
}

TEST(GltfAnimation, NeighbouringRotationsNeverPointApart) {
  const Rig rig = MakeRig();
  GltfAnimation animation(rig);
  for (int i = 0; i < 40; ++i)
    animation.Add(i * 10000, Head{0, static_cast<float>(i * 20 % 360 - 180), 0, 0, 0, 0},
                  Pose(rig, {}));
  const Read read(animation.Encode("take"));
  const aiNodeAnim& head = *read.moves("head");
  for (unsigned i = 1; i < head.mNumRotationKeys; ++i) {
    const aiQuaternion& a = head.mRotationKeys[i - 1].mValue;
    const aiQuaternion& b = head.mRotationKeys[i].mValue;
    EXPECT_GE(a.w * b.w + a.x * b.x + a.y * b.y + a.z * b.z, 0) << i;
  }
}

TEST(GltfAnimation, ParametersAreMorphTargetsUnderTheirNames) {
  const Rig rig = MakeRig();
  GltfAnimation animation(rig);
  animation.Add(0, Head{}, Pose(rig, {{"jawOpen", 0.75F}, {"jaw_deg", 20}}));
  const std::string glb = animation.Encode("take");
  const Read read(glb);
  const aiMesh& face = *read.scene().mMeshes[read.node("face").mMeshes[0]];
  ASSERT_EQ(face.mNumAnimMeshes, 2U);
  EXPECT_STREQ(face.mAnimMeshes[0]->mName.C_Str(), "jawOpen");
  EXPECT_STREQ(face.mAnimMeshes[1]->mName.C_Str(), "jaw_deg");
  ASSERT_EQ(read.morphs().mKeys[0].mNumValuesAndWeights, 2U);
  EXPECT_NEAR(read.morphs().mKeys[0].mWeights[0], 0.75, 1e-6);
  // An angle is the part of its range, which the file names.
  EXPECT_NEAR(read.morphs().mKeys[0].mWeights[1], 0.75, 1e-6);
  EXPECT_THAT(glb, testing::HasSubstr("\"facewireRanges\":{\"jaw_deg\":[-10.0,30.0]}"));
}

TEST(GltfAnimation, AFrameWithoutAFaceHoldsThePoseBeforeIt) {
  const Rig rig = MakeRig();
  GltfAnimation animation(rig);
  animation.AddLost(0);
  animation.Add(10000, Head{0, 5, 0, 0, 0, 0}, Pose(rig, {{"jawOpen", 1}}));
  animation.AddLost(20000);
  const Read read(animation.Encode("take"));
  ASSERT_EQ(read.morphs().mNumKeys, 3U);
  EXPECT_NEAR(read.morphs().mKeys[0].mWeights[0], 0.25, 1e-6) << "the rig's neutral";
  EXPECT_NEAR(read.morphs().mKeys[2].mWeights[0], 1, 1e-6);
  ExpectSame(read.moves("head")->mRotationKeys[2].mValue.GetMatrix(), Rotation(0, 5, 0));
}

TEST(GltfAnimation, AnEmptyPerformanceIsACharacterAtRest) {
  const Rig rig = MakeRig();
  const Read read(GltfAnimation(rig).Encode("take"));
  EXPECT_EQ(read.scene().mNumAnimations, 0U);
  EXPECT_NE(read.scene().mRootNode->FindNode("face"), nullptr);
}

TEST(GltfAnimation, ARigMayHaveOnlyBonesOrOnlyParametersOrNothing) {
  Rig bones;
  bones.name = *ShortName::From("bones");
  AddBone(bones, "jaw", {});
  AddChannel(bones, "jaw.pitch", ChannelKind::kPitch, 0, -90, 90);
  Rig shapes;
  shapes.name = *ShortName::From("shapes");
  AddChannel(shapes, "jawOpen", ChannelKind::kParameter, -1, 0, 1);
  Rig nothing;
  nothing.name = *ShortName::From("nothing");
  for (const Rig* rig : {&bones, &shapes, &nothing}) {
    GltfAnimation animation(*rig);
    animation.Add(0, Head{}, rig->NeutralPose());
    const std::string glb = animation.Encode("take");
    EXPECT_EQ(glb.substr(0, 4), "glTF");
    std::uint32_t length = 0;
    std::memcpy(&length, glb.data() + 8, sizeof(length));
    EXPECT_EQ(length, glb.size());
    EXPECT_THAT(glb, testing::HasSubstr("\"take\""));
  }
}

TEST(GltfAnimation, ALongTakeOfAFullRigStaysSmall) {
  Rig rig;
  rig.name = *ShortName::From("full");
  for (std::size_t i = 0; i < kMaxChannels; ++i)
    AddChannel(rig, "p" + std::to_string(i), ChannelKind::kParameter, -1, 0, 1);
  GltfAnimation animation(rig);
  for (int i = 0; i < 3000; ++i) animation.Add(i * 10000, Head{}, rig.NeutralPose());
  EXPECT_LT(animation.Encode("take").size(), 4U << 20U);
}

}  // namespace
}  // namespace facewire::tools
