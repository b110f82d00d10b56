#include "tools/facewire/rig/rig_check.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "app/rig_file.h"
#include "app/servo_rig_file.h"
#include "tools/facewire/rig/shape_names.h"

namespace facewire::tools::rig {
namespace {

using testing::Contains;
using testing::Each;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

std::vector<std::string> CheckFile(const std::filesystem::path& file) {
  const Rig rig = app::LoadRig(file);
  const std::vector<std::string> signals(ArkitShapes().begin(), ArkitShapes().end() - 1);
  std::vector<std::string> lines;
  for (const Remark& remark : CheckRig(rig, app::LoadServoRig(file, rig), signals))
    lines.push_back((remark.lacks ? "lacks " : "hint ") + remark.text);
  return lines;
}

std::vector<std::string> Check(const std::string& toml) {
  const std::filesystem::path file =
      testing::TempDir() + "/rig_check_" + std::to_string(::getpid()) + ".toml";
  std::ofstream(file) << "name = \"x\"\n" << toml;
  const std::vector<std::string> lines = CheckFile(file);
  std::filesystem::remove(file);
  return lines;
}

TEST(RigCheck, FindsNothingLackingInTheDefaultRig) {
  EXPECT_THAT(CheckFile(std::string(FACEWIRE_SOURCE_DIR) + "/app/share/otto.toml"),
              Each(Not(StartsWith("lacks"))));
}

TEST(RigCheck, SaysWhatOfAFaceNobodyWouldSee) {
  const auto lines = Check("[[parameter]]\nname = \"eyeBlinkLeft\"\nmax_speed = 25\n");
  EXPECT_THAT(lines, Not(Contains(HasSubstr("blink of the left"))));
  EXPECT_THAT(lines, Contains(HasSubstr("lacks a blink of the right eye: no channel is driven by "
                                        "eyeBlinkRight")));
  for (const char* const what : {"an open mouth", "a smile", "brows", "eyes look", "head turns"})
    EXPECT_THAT(lines, Contains(HasSubstr(what)));
}

TEST(RigCheck, TakesABoneThatFollowsForWhatItShows) {
  EXPECT_THAT(Check("[[bone]]\nname = \"c\"\nlandmark = \"chin\"\ny = { min = -3, max = 1 }\n"),
              Not(Contains(HasSubstr("an open mouth"))));
}

TEST(RigCheck, NamesSignalsThatNoProfileGives) {
  EXPECT_THAT(Check("[[parameter]]\nname = \"ears\"\ndrive = { earWiggle = 1 }\n"),
              Contains(HasSubstr("ears: the profile has no signal earWiggle")));
}

TEST(RigCheck, NamesRangesThatAreNotReachedAndSignalsThatAreCut) {
  const auto lines = Check(
      "[[bone]]\nname = \"jaw\"\n"
      "pitch = { min = -2, max = 40, max_speed = 1, max_acceleration = 1, drive = { jawOpen = 10 } "
      "}\n"
      "yaw = { min = -5, max = 5, max_speed = 1, max_acceleration = 1, drive = { jawLeft = 20, "
      "jawRight = "
      "-5 } }\n");
  EXPECT_THAT(lines, Contains(HasSubstr("jaw.pitch: never comes near its max; full signals take it "
                                        "10 of 40 that way")));
  EXPECT_THAT(lines, Contains(HasSubstr("jaw.yaw: is at its max with 25 % of its signals")));
  EXPECT_THAT(lines, Not(Contains(HasSubstr("its min"))));
}

TEST(RigCheck, NamesMotionWithoutALimit) {
  const auto lines = Check(
      "[[parameter]]\nname = \"jawOpen\"\n[[bone]]\nname = \"b\"\n"
      "pitch = { min = -1, max = 1, max_speed = 9, drive = { \"head.pitch\" = 1 } }\n");
  EXPECT_THAT(lines, Contains(HasSubstr("no limit of speed (max_speed): jawOpen;")));
  EXPECT_THAT(lines, Contains(HasSubstr("no limit of acceleration (max_acceleration): b.pitch;")));
}

TEST(RigCheck, NamesTheSideThatIsAlone) {
  EXPECT_THAT(Check("[[parameter]]\nname = \"mouthSmileLeft\"\n"),
              Contains(HasSubstr("only one side answers: mouthSmileLeft")));
}

TEST(RigCheck, NamesWhatServosLose) {
  const auto lines = Check(
      "[[bone]]\nname = \"jaw\"\n"
      "pitch = { min = 0, max = 20, drive = { jawOpen = 20 } }\n"
      "yaw = { min = -5, max = 5, drive = { jawLeft = 5, jawRight = -5 } }\n"
      "[[servo]]\nname = \"s\"\nbus = \"b\"\nid = 0\nfrom = { \"jaw.pitch\" = 1 }\n"
      "map = [[0, 1000], [10, 2000]]\nmax_speed = 1000\n"
      "[[servo]]\nname = \"spare\"\nbus = \"b\"\nid = 1\nmin = 1000\nmax = 2000\nneutral = 1500\n"
      "max_speed = 1000\nmax_acceleration = 9000\n");
  EXPECT_THAT(
      lines,
      Contains(HasSubstr("servo s: its map ends at 0 and 10, its channels go from 0 to 20")));
  EXPECT_THAT(lines,
              Contains(HasSubstr("servos without a limit of acceleration (max_acceleration): s")));
  EXPECT_THAT(lines, Contains(HasSubstr("servos that no channel moves (no from): spare")));
  EXPECT_THAT(lines, Contains(HasSubstr("channels of bones that no servo shows: jaw.yaw")));
}

}  // namespace
}  // namespace facewire::tools::rig
