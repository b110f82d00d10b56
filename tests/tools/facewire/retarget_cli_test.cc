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

}  // namespace
}  // namespace facewire::tools
