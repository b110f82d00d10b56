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

// A profile of the markers in that file.
std::string Trained(const Scratch& scratch, const std::string& markers) {
  const std::string profile = scratch.Path("p.profile");
  EXPECT_EQ(RunFacewire({"train", "--markers", markers, "--targets",
                         scratch.Write("t.csv", kTargets), "--out", profile})
                .code,
            0);
  return profile;
}

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

TEST(FacewireRetarget, SaysAtTheEndWhichPoseTheTrainingLacks) {
  const Scratch scratch;
  const std::string markers = scratch.Write("m.csv", kMarkers);
  const std::string profile = Trained(scratch, markers);
  // After a trained pose, a smile that nobody trained.
  const std::string take = std::string(kMarkers) + "0,-8,4,4.5,-2,4,-4.5,-2,4\n";
  const auto retarget = [&](const std::string& input) {
    return RunFacewire({"retarget", input, "--rig", scratch.Write("rig.toml", kRig), "--profile",
                        profile, "--neutral", "0:1", "--out", scratch.Path("out.csv")});
  };
  const Outcome familiar = retarget(markers);
  ASSERT_EQ(familiar.code, 0) << familiar.err;
  EXPECT_EQ(familiar.err, "facewire retarget: 3 frames, 60 a second, a face in 3\n");
  const Outcome outcome = retarget(scratch.Write("take.csv", take));
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("facewire retarget: face: 1 frame unlike any trained pose, "
                                     "most so frame 3 (0:00.0); record a pose like it"));
}

TEST(FacewireRetarget, NamesTheMarkersThatAProfileMisses) {
  const Scratch scratch;
  const std::string markers = scratch.Write("m.csv", kMarkers);
  const std::string profile = Trained(scratch, markers);
  const std::string other = scratch.Write("other.csv", "chin_x,chin_y,chin_z\n0,-8,4\n");
  const Outcome outcome = RunFacewire({"retarget", other, "--rig", scratch.Write("rig.toml", kRig),
                                       "--profile", profile, "--out", scratch.Path("out.jsonl")});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("there is no marker lipL, and no lipR"));
}

// The performer's own profile wants half of jawOpen.
TEST(FacewireRetarget, BlendsAPersonalProfileIn) {
  const Scratch scratch;
  const std::string markers = scratch.Write("m.csv", kMarkers);
  const std::string rig = scratch.Write("rig.toml", kRig);
  const auto train = [&](const std::string& from, const char* targets, const char* name) {
    const Outcome trained =
        RunFacewire({"train", "--markers", from, "--targets", scratch.Write("t.csv", targets),
                     "--out", scratch.Path(name)});
    EXPECT_EQ(trained.code, 0) << trained.err;
    return scratch.Path(name);
  };
  const std::string profile = train(markers, kTargets, "p.profile");
  const std::string own = train(markers, "jawOpen\n0\n0.25\n0.5\n", "own.profile");
  const auto retarget = [&](std::vector<std::string> more) {
    std::vector<std::string> all = {
        "retarget", markers,     "--rig", rig,     "--profile",
        profile,    "--neutral", "0:1",   "--out", scratch.Path("out.csv")};
    all.insert(all.end(), more.begin(), more.end());
    return RunFacewire(all);
  };
  const auto last_value = [&](std::vector<std::string> more) {
    const Outcome outcome = retarget(std::move(more));
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    const std::string out = scratch.Read("out.csv");
    return std::stod(out.substr(out.rfind(',') + 1));
  };
  EXPECT_NEAR(last_value({"--personal", own}), 0.5, 0.02) << "alone";
  EXPECT_NEAR(last_value({"--personal", own, "--blend", "50"}), 0.75, 0.02);
  EXPECT_NEAR(last_value({"--personal", own, "--blend", "0"}), 1, 0.02);

  const Outcome beyond = retarget({"--personal", own, "--blend", "101"});
  EXPECT_EQ(beyond.code, 2);
  EXPECT_THAT(beyond.err, HasSubstr("--blend"));
  const Outcome alone = retarget({"--blend", "50"});
  EXPECT_EQ(alone.code, 2);
  EXPECT_THAT(alone.err, HasSubstr("--personal"));
  const std::string other =
      scratch.Write("other.csv", "cheek_x,cheek_y,cheek_z\n0,-8,4\n0,-9,4\n0,-10,4\n");
  const Outcome foreign = retarget({"--personal", train(other, kTargets, "other.profile")});
  EXPECT_EQ(foreign.code, 2);
  EXPECT_THAT(foreign.err,
              HasSubstr("other.profile: reads markers that the profile does not have"));
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
