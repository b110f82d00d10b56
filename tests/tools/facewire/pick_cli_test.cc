#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "tests/tools/facewire/run.h"

namespace facewire::tools {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

// A second at rest, a second with the chin down by 2 cm, a second at rest; a lid that never moves.
std::string Take(const Scratch& scratch) {
  std::string rows = "frame,time_s,chin_x,chin_y,chin_z,lid_x,lid_y,lid_z\n";
  for (int i = 0; i < 180; ++i) {
    const char* chin = i >= 60 && i < 120 ? "0,-10,4" : "0,-8,4";
    rows += std::to_string(100 + i) + "," + std::to_string(i / 60.0) + "," + chin + ",3,3,3\n";
  }
  return scratch.Write("take.csv", rows);
}

TEST(FacewirePick, WritesMarkersAndATemplateThatTrainTakesWhenItIsFilledIn) {
  const Scratch scratch;
  const std::string samples = scratch.Path("frames.csv");
  const std::string targets = scratch.Path("targets.csv");
  const Outcome outcome = RunFacewire({"pick", Take(scratch), "--out", samples, "--targets",
                                       "jawOpen,jawLeft", "--template", targets});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("the face at rest\n"));
  EXPECT_THAT(outcome.out, HasSubstr("100.0 %  chin +0.0 -2.0 +0.0"));
  EXPECT_THAT(outcome.out, HasSubstr("2 frames explain 100 % of the motion"));
  const std::string rows = scratch.Read("frames.csv");
  EXPECT_EQ(std::ranges::count(rows, '\n'), 3);
  EXPECT_THAT(rows, StartsWith("frame,t_us,chin_x,chin_y,chin_z,lid_x,lid_y,lid_z\n1"));
  std::string blank = scratch.Read("targets.csv");
  EXPECT_THAT(blank, StartsWith("frame,jawOpen,jawLeft\n"));
  EXPECT_THAT(blank, HasSubstr(",0,0\n"));
  EXPECT_THAT(blank, testing::EndsWith(",,\n"));

  const std::vector<std::string> train = {
      "train", "--markers", samples, "--targets", targets, "--out", scratch.Path("p.profile")};
  const Outcome empty = RunFacewire(train);
  EXPECT_EQ(empty.code, 2);
  EXPECT_THAT(empty.err, HasSubstr("targets.csv:3: column jawOpen is empty"));
  scratch.Write("targets.csv", blank.replace(blank.size() - 3, 3, ",1,0\n"));
  EXPECT_EQ(RunFacewire(train).code, 0);
}

TEST(FacewirePick, AnswersBadInputWithOneLineAndNoFile) {
  const Scratch scratch;
  const std::string out = scratch.Path("out.csv");
  const std::string take = Take(scratch);
  const std::string filled = scratch.Write("filled.csv", "frame,a\n0,0\n");
  const std::string gaps = scratch.Write("gaps.csv", "a_x,a_y,a_z,b_x,b_y,b_z\n1,2,3,,,\n");
  struct Case {
    std::vector<std::string> arguments;
    std::string says;
  };
  const Case cases[] = {
      {{take}, "--out is required"},
      {{take, "--out", out, "--count", "few"}, "--count few: a whole number"},
      {{take, "--out", out, "--count", "1"}, "--count 1: auto, or 2 to"},
      {{take, "--out", out, "--tolerance", "2"}, "--tolerance"},
      {{take, "--out", out, "--neutral", "99"}, "--neutral 99: no frame of this number"},
      {{take, "--out", out, "--neutral", "x"}, "--neutral x: a whole number"},
      {{take, "--out", out, "--targets", "a"}, "--targets and --template belong together"},
      {{take, "--out", out, "--template", "t.csv"}, "belong together"},
      {{take, "--out", out, "--targets", "a,a", "--template", "t.csv"}, "a appears twice"},
      {{take, "--out", out, "--targets", "a b", "--template", "t.csv"}, "cannot be a name"},
      {{take, "--out", out, "--targets", "a", "--template", filled}, "is there already"},
      {{take, "--out", out, "--markers", "chim"}, "did you mean \"chin\"?"},
      {{gaps, "--out", out}, "no frame in which every marker is seen"},
      {{"v4l2:/dev/video0", "--out", out}, "pick looks at a whole recording"},
  };
  const std::size_t files = scratch.Files();
  for (const Case& bad : cases) {
    std::vector<std::string> arguments = {"pick"};
    arguments.insert(arguments.end(), bad.arguments.begin(), bad.arguments.end());
    const Outcome outcome = RunFacewire(arguments);
    EXPECT_EQ(outcome.code, 2) << bad.says << ": " << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr(bad.says));
    EXPECT_EQ(std::ranges::count(outcome.err, '\n'), 1) << outcome.err;
    EXPECT_EQ(outcome.out, "");
  }
  EXPECT_EQ(scratch.Files(), files);
  EXPECT_EQ(scratch.Read("filled.csv"), "frame,a\n0,0\n");
}

}  // namespace
}  // namespace facewire::tools
