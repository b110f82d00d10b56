#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>
#include <string>

#include "tests/tools/facewire/run.h"

namespace facewire::tools {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

// A face of two shapes, as text.
constexpr char kCharacter[] =
    R"({"asset":{"version":"2.0"},"meshes":[{"extras":{"targetNames":["jawOpen","Blink_L"]},)"
    R"("primitives":[{"targets":[{"POSITION":0},{"POSITION":0}]}]}],"accessors":[{}]})";

TEST(FacewireRig, MakesChecksAndDrawsARig) {
  const Scratch scratch;
  const std::string character = scratch.Write("head.gltf", kCharacter);
  const std::string rig = scratch.Path("rig.toml");
  const Outcome imported = RunFacewire({"rig", "import", character, "--out", rig});
  ASSERT_EQ(imported.code, 0) << imported.err;
  EXPECT_THAT(imported.out, AllOf(HasSubstr("2 of 52 shown"), HasSubstr("Blink_L")));
  const Outcome checked = RunFacewire({"rig", "check", rig});
  EXPECT_EQ(checked.code, 0) << checked.err;
  EXPECT_THAT(checked.out, AllOf(StartsWith("head: 0 bones, 2 channels, 0 servos\n"),
                                 HasSubstr("lacks a blink of the right eye"),
                                 HasSubstr("5 lacking, 0 hints\n")));
  const Outcome drawn = RunFacewire({"rig", "show", rig, "--out", scratch.Path("rig.png")});
  EXPECT_EQ(drawn.code, 0) << drawn.err;
  EXPECT_EQ(cv::imread(scratch.Path("rig.png")).cols, 1600);
}

TEST(FacewireRig, OverwritesARigOnlyByForce) {
  const Scratch scratch;
  const std::string character = scratch.Write("head.gltf", kCharacter);
  const std::string rig = scratch.Write("rig.toml", "mine");
  const Outcome refused = RunFacewire({"rig", "import", character, "--out", rig});
  EXPECT_EQ(refused.code, 2);
  EXPECT_THAT(refused.err, HasSubstr("--force"));
  EXPECT_EQ(scratch.Read("rig.toml"), "mine");
  EXPECT_EQ(RunFacewire({"rig", "import", character, "--out", rig, "--force"}).code, 0);
  EXPECT_THAT(scratch.Read("rig.toml"), HasSubstr("jawOpen"));
}

TEST(FacewireRig, LeavesNothingBehindOfABrokenCharacter) {
  const Scratch scratch;
  const std::string broken = scratch.Write("head.glb", "glTF\2");
  const Outcome outcome = RunFacewire({"rig", "import", broken, "--out", scratch.Path("r.toml")});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("head.glb: is cut off after 5 bytes"));
  EXPECT_EQ(scratch.Files(), 1U);
}

TEST(FacewireRig, RefusesARigThatDoesNotLoad) {
  const Scratch scratch;
  const std::string rig = scratch.Write("rig.toml", "name = 3\n");
  for (const std::vector<std::string>& command :
       {std::vector<std::string>{"rig", "check", rig},
        {"rig", "show", rig, "--out", scratch.Path("rig.png")}}) {
    const Outcome outcome = RunFacewire(command);
    EXPECT_EQ(outcome.code, 2);
    EXPECT_THAT(outcome.err, HasSubstr("rig.toml:1:"));
  }
  EXPECT_EQ(scratch.Files(), 1U);
}

}  // namespace
}  // namespace facewire::tools
