#include "tools/facewire/servo/rig_text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/rig_file.h"
#include "app/servo_rig_file.h"
#include "tests/app/scratch.h"

namespace facewire::tools {
namespace {

using app::BadInputOf;
using app::Replaced;
using app::Scratch;
using testing::HasSubstr;

// As a builder may have written it: comments, odd spaces, other alphabets, tables in tables.
constexpr const char* kRig = R"(# Mäxchen's head — by hand
name = "head"

[[parameter]]
name = "jawOpen"
drive = { jawOpen = 1 }

[[servo]]   # the jaw
  name = "jaw"        # ü
  bus = "head"
  map = [ [0, 1180],  [0.4, 1300], # öpen
          [1, 1760] ]          # keep this
  id = 0x05
	max_speed = 4000     # µs/s
  min = 1200.0    # keep that
  [servo.from]
  "jawOpen" = 1

[[servo]]
name = "lid"
bus = "head"
id = 1
from = { jawOpen = 1 }
map = [[0, 1900], [1, 1100]]  # falls
max_speed = 6000

[[servo]]
name = "tail"
bus = "head"
id = 2
min = 1000
max = 2000
max_speed = 100)";

TEST(RigText, ReplacesNumbersWhereTheyStandAndNothingElse) {
  const std::string edited = EditServo(kRig, "jaw", {.min = 1210.25, .neutral = 1300});
  std::string expected = Replaced(kRig, "min = 1200.0 ", "min = 1210.25 ");
  // A key that was not there stands below the map, not in the table that follows.
  expected = Replaced(expected, "# keep this\n", "# keep this\n  neutral = 1300\n");
  EXPECT_EQ(edited, expected);
}

TEST(RigText, MovesTheMapsEndsInItsOwnDirection) {
  EXPECT_EQ(EditServo(kRig, "lid", {.min = 1000, .max = 2000, .map_ends = true}),
            Replaced(kRig, "[[0, 1900], [1, 1100]]", "[[0, 2000], [1, 1000]]"));
  // What is between the ends keeps its part of the way; min was there, max was not.
  std::string expected = Replaced(kRig, "[0, 1180],  [0.4, 1300]", "[0, 1000],  [0.4, 1206.9]");
  expected = Replaced(expected, "[1, 1760] ]", "[1, 2000] ]");
  expected = Replaced(expected, "min = 1200.0 ", "min = 1000 ");
  EXPECT_EQ(EditServo(kRig, "jaw", {.min = 1000, .max = 2000, .map_ends = true}), expected);
}

TEST(RigText, TheMapTakesTheOldNeutralToTheNewOne) {
  const std::string rig =
      "[[servo]]\nname = \"lid\"\nid = 1\nmap = [[-12, 1626], [0, 1500], [45, 1100]]\n";
  EXPECT_EQ(
      EditServo(rig, "lid",
                {.min = 1000, .max = 1700, .neutral = 1510, .map_ends = true, .neutral_was = 1500}),
      "[[servo]]\nname = \"lid\"\nid = 1\nmap = [[-12, 1700], [0, 1510], [45, 1000]]\n"
      "neutral = 1510\n");
  // Where there is nothing on one side of it, all moves along evenly.
  EXPECT_EQ(
      EditServo(rig, "lid",
                {.min = 1000, .max = 2000, .neutral = 1000, .map_ends = true, .neutral_was = 1500}),
      "[[servo]]\nname = \"lid\"\nid = 1\nmap = [[-12, 2000], [0, 1760.46], [45, 1000]]\n"
      "neutral = 1000\n");
}

TEST(RigText, AServoWithoutAMapHasItsLimitsAndTheLastLineNeedsNoEnd) {
  EXPECT_EQ(EditServo(kRig, "tail", {.min = 900, .max = 2100, .neutral = 1400, .map_ends = true}),
            Replaced(Replaced(kRig, "min = 1000\n", "neutral = 1400\nmin = 900\n"), "max = 2000",
                     "max = 2100"));
  EXPECT_EQ(EditServo("[[servo]]\nname = \"a\"\nid = 1", "a", {.neutral = 2}),
            "[[servo]]\nname = \"a\"\nid = 1\nneutral = 2\n");
}

TEST(RigText, KeepsTheLineEndsOfAnotherSystem) {
  const std::string dos = Replaced(kRig, "\n", "\r\n");
  EXPECT_EQ(EditServo(dos, "lid", {.neutral = 1500}),
            Replaced(EditServo(kRig, "lid", {.neutral = 1500}), "\n", "\r\n"));
}

TEST(RigText, SaysWhatItCannotEdit) {
  EXPECT_EQ(BadInputOf([] { (void)EditServo(kRig, "nose", {}); }), "no servo \"nose\" in this rig");
  EXPECT_THAT(
      BadInputOf([] { (void)EditServo("servo = [{ name = \"a\", id = 1 }]", "a", {.min = 1}); }),
      HasSubstr("write it as a [[servo]]"));
  EXPECT_THAT(BadInputOf([] { (void)EditServo("a = = 1", "a", {}); }), HasSubstr("line 1"));
}

TEST(RigText, PositionsAreWrittenWithoutNeedlessDigits) {
  EXPECT_EQ(PositionText(1500), "1500");
  EXPECT_EQ(PositionText(1499.25), "1499.25");
  EXPECT_EQ(PositionText(1499.5), "1499.5");
  EXPECT_EQ(PositionText(-0.001), "0");
}

TEST(RigText, ARigIsReplacedOnlyByOneThatLoads) {
  const Scratch scratch;
  const auto file = scratch.Write("rig.toml", kRig);
  const std::string bad = EditServo(kRig, "tail", {.min = 3000});
  const std::string why = BadInputOf([&] { ReplaceRig(file, bad); });
  EXPECT_THAT(why, HasSubstr(file.string() + ":"));
  EXPECT_THAT(why, HasSubstr("is not below max"));
  EXPECT_EQ(Scratch::Read(file), kRig);

  ReplaceRig(file, EditServo(kRig, "tail", {.min = 900}));
  EXPECT_EQ(scratch.files(), 1U);
  const Rig rig = app::LoadRig(file);
  EXPECT_EQ(app::LoadServoRig(file, rig).servos[2].min, 900);
}

}  // namespace
}  // namespace facewire::tools
