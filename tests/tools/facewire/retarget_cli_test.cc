#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
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

TEST(FacewireRetarget, SaysAtTheEndWhichPoseTheTrainingLacks) {
  const Scratch scratch;
  const std::string markers = scratch.Write("m.csv", kMarkers);
  const std::string profile = scratch.Path("p.profile");
  ASSERT_EQ(RunFacewire({"train", "--markers", markers, "--targets",
                         scratch.Write("t.csv", kTargets), "--out", profile})
                .code,
            0);
  // After a trained pose, a smile that nobody trained.
  const std::string take = std::string(kMarkers) + "0,-8,4,4.5,-2,4,-4.5,-2,4\n";
  const auto retarget = [&](const std::string& input) {
    return RunFacewire({"retarget", input, "--rig", scratch.Write("rig.toml", kRig), "--profile",
                        profile, "--neutral", "0:1", "--out", scratch.Path("out.csv")});
  };
  const Outcome familiar = retarget(markers);
  ASSERT_EQ(familiar.code, 0) << familiar.err;
  EXPECT_EQ(familiar.err, "facewire retarget: 3 frames, a face in 3\n");
  const Outcome outcome = retarget(scratch.Write("take.csv", take));
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("facewire retarget: face: 1 frame unlike any trained pose, "
                                     "most so frame 3 (0:00.0); record a pose like it"));
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

}  // namespace
}  // namespace facewire::tools
