#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <sstream>
#include <string>

#include "tests/tools/facewire/run.h"

namespace facewire::tools {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

constexpr char kRig[] = "name = \"mini\"\n[[parameter]]\nname = \"jawOpen\"\n";
// A chin that goes down by 2 cm, and lip corners that follow a little.
constexpr char kMarkers[] =
    "chin_x,chin_y,chin_z,lipL_x,lipL_y,lipL_z,lipR_x,lipR_y,lipR_z\n"
    "0,-8,4,2.5,-4,4,-2.5,-4,4\n0,-9,4,2.5,-4.1,4,-2.5,-4.1,4\n0,-10,4,2.5,-4.2,4,-2.5,-4.2,4\n";
constexpr char kTargets[] = "jawOpen\n0\n0.5\n1\n";

TEST(FacewireRetarget, DrivesAParameterFromMarkersWithATrainedProfile) {
  const Scratch scratch;
  const std::string markers = scratch.Write("m.csv", kMarkers);
  const std::string rig = scratch.Write("rig.toml", kRig);
  const std::string profile = scratch.Path("p.profile");
  const Outcome trained = RunFacewire({"train", "--markers", markers, "--targets",
                                       scratch.Write("t.csv", kTargets), "--out", profile});
  ASSERT_EQ(trained.code, 0) << trained.err;
  const Outcome outcome = RunFacewire({"retarget", markers, "--rig", rig, "--profile", profile,
                                       "--neutral", "0:1", "--out", scratch.Path("out.csv")});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const std::string out = scratch.Read("out.csv");
  EXPECT_THAT(out, StartsWith("frame,t_us,state,head.pitch,head.yaw,head.roll,head.x,head.y,head.z,"
                              "jawOpen\n0,0,tracking,"));
  const std::string last = out.substr(out.rfind(',') + 1);
  EXPECT_NEAR(std::stod(last), 1, 0.01);
}

TEST(FacewireRetarget, NamesTheMarkersThatAProfileMisses) {
  const Scratch scratch;
  const std::string markers = scratch.Write("m.csv", kMarkers);
  const std::string profile = scratch.Path("p.profile");
  ASSERT_EQ(RunFacewire({"train", "--markers", markers, "--targets",
                         scratch.Write("t.csv", kTargets), "--out", profile})
                .code,
            0);
  const std::string other = scratch.Write("other.csv", "chin_x,chin_y,chin_z\n0,-8,4\n");
  const Outcome outcome = RunFacewire({"retarget", other, "--rig", scratch.Write("rig.toml", kRig),
                                       "--profile", profile, "--out", scratch.Path("out.jsonl")});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("lipL, lipR"));
}

TEST(FacewireRetarget, DrivesTheDefaultCharacterFromAVideo) {
  const Scratch scratch;
  const Outcome outcome = RunFacewire({"retarget", ShortClip(scratch, 6), "--rig",
                                       FACEWIRE_SOURCE_DIR "/app/share/otto.toml", "--profile",
                                       FACEWIRE_SOURCE_DIR "/app/share/average.profile",
                                       "--neutral", "0:3", "--out", scratch.Path("out.jsonl")});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const std::string lines = scratch.Read("out.jsonl");
  EXPECT_EQ(std::ranges::count(lines, '\n'), 6);
  EXPECT_THAT(lines,
              StartsWith("{\"frame\":0,\"t_us\":0,\"state\":\"tracking\",\"head\":{\"pitch\":"));
  EXPECT_THAT(lines, HasSubstr("\"jaw\":{\"pos\":["));
  EXPECT_THAT(lines, HasSubstr("\"jawOpen\":"));
}

// A profile of the markers above; what the retarget of those markers to `out` came to.
Outcome RetargetMarkers(const Scratch& scratch, const std::string& out) {
  const std::string markers = scratch.Write("m.csv", kMarkers);
  const std::string profile = scratch.Path("p.profile");
  const Outcome trained = RunFacewire({"train", "--markers", markers, "--targets",
                                       scratch.Write("t.csv", kTargets), "--out", profile});
  EXPECT_EQ(trained.code, 0) << trained.err;
  return RunFacewire({"retarget", markers, "--rig", scratch.Write("rig.toml", kRig), "--profile",
                      profile, "--neutral", "0:1", "--out", scratch.Path(out)});
}

TEST(FacewireRetarget, WritesAGltfAnimationWithTheValuesOfTheJsonLines) {
  const Scratch scratch;
  ASSERT_EQ(RetargetMarkers(scratch, "out.jsonl").code, 0);
  ASSERT_EQ(RetargetMarkers(scratch, "out.glb").code, 0);
  Assimp::Importer importer;
  const aiScene* scene =
      importer.ReadFile(scratch.Path("out.glb"), aiProcess_ValidateDataStructure);
  ASSERT_NE(scene, nullptr) << importer.GetErrorString();
  const aiMeshMorphAnim& weights = *scene->mAnimations[0]->mMorphMeshChannels[0];
  ASSERT_EQ(weights.mNumKeys, 3U);
  std::istringstream lines(scratch.Read("out.jsonl"));
  std::string line;
  for (unsigned frame = 0; std::getline(lines, line); ++frame) {
    const auto number_after = [&](const std::string& key) {
      return std::stod(line.substr(line.find(key) + key.size()));
    };
    EXPECT_NEAR(weights.mKeys[frame].mTime, number_after("\"t_us\":") / 1000, 1e-3);
    EXPECT_NEAR(weights.mKeys[frame].mWeights[0], number_after("\"jawOpen\":"), 1e-5);
  }
}

TEST(FacewireRetarget, KnowsItsFormatsByTheirEndingsInAnyCase) {
  const Scratch scratch;
  ASSERT_EQ(RetargetMarkers(scratch, "out.GLB").code, 0);
  EXPECT_THAT(scratch.Read("out.GLB"), StartsWith("glTF"));
}

TEST(FacewireRetarget, SaysHowManyFramesASecondThereAre) {
  const Scratch scratch;
  EXPECT_THAT(RetargetMarkers(scratch, "out.jsonl").err,
              HasSubstr("3 frames, 60 a second, a face in 3"));
}

TEST(FacewireRetarget, SaysWhichKindOfGltfItWrites) {
  const Scratch scratch;
  const Outcome outcome = RetargetMarkers(scratch, "out.gltf");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("its name ends in .glb"));
}

TEST(FacewireRetarget, LeavesNoHalfGltfBehindWhenTheNeutralCannotBeTaken) {
  const Scratch scratch;
  ASSERT_EQ(RetargetMarkers(scratch, "out.glb").code, 0);
  const std::string before = scratch.Read("out.glb");
  const std::size_t files = scratch.Files();
  const Outcome outcome = RunFacewire(
      {"retarget", scratch.Path("m.csv"), "--rig", scratch.Path("rig.toml"), "--profile",
       scratch.Path("p.profile"), "--neutral", "7:9", "--out", scratch.Path("out.glb")});
  EXPECT_EQ(outcome.code, 2) << outcome.err;
  EXPECT_EQ(scratch.Read("out.glb"), before);
  EXPECT_EQ(scratch.Files(), files);
}

}  // namespace
}  // namespace facewire::tools
