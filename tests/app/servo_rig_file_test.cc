#include "app/servo_rig_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <string>

#include "app/rig_file.h"
#include "tests/app/scratch.h"

namespace facewire::app {
namespace {

using servo::Relation;
using servo::Servo;
using servo::ServoRig;
using std::chrono::milliseconds;
using std::chrono::seconds;
using ::testing::HasSubstr;

// Line 1 to 5; what a test writes begins at line 6.
const char* const kRig = R"(name = "test"
[[bone]]
name = "jaw"
pitch = { min = 0, max = 20, neutral = 5, drive = { "head.pitch" = 1 } }
yaw = { min = -20, max = 20, drive = { "head.yaw" = 1 } }
)";

ServoRig Load(const std::string& text) {
  const Scratch scratch;
  const auto file = scratch.Write("rig.toml", kRig + text);
  return LoadServoRig(file, LoadRig(file));
}

std::string Complaint(const std::string& text) {
  const Scratch scratch;
  const auto file = scratch.Write("rig.toml", kRig + text);
  const std::string what = ProblemsOf([&] { (void)LoadServoRig(file, LoadRig(file)); });
  return Replaced(what, file.string(), "F");
}

TEST(LoadServoRig, ARigWithoutServosHasNone) { EXPECT_EQ(Load("").servos.size(), 0U); }

TEST(LoadServoRig, ReadsServosWithEverything) {
  const ServoRig rig = Load(R"(
[[servo]]
name = "jaw_left"
bus = "head"
id = 3
from = { "jaw.pitch" = 0.5, "jaw.yaw" = -1 }
offset = 2
map = [[0, 1900], [10, 1500], [20, 1100]]
min = 1150
max = 1850
neutral = 1400
dead_band = 3
backlash = 6
max_speed = 4000
max_acceleration = 60000
crawl_speed = 250
limp_after_s = 20
)");
  ASSERT_EQ(rig.servos.size(), 1U);
  const Servo& servo = rig.servos[0];
  EXPECT_EQ(servo.name.view(), "jaw_left");
  EXPECT_EQ(servo.bus.view(), "head");
  EXPECT_EQ(servo.id, 3);
  ASSERT_EQ(servo.sources.size(), 2U);
  EXPECT_EQ(servo.sources[0].channel.view(), "jaw.pitch");
  EXPECT_EQ(servo.sources[0].gain, 0.5F);
  EXPECT_EQ(servo.sources[1].gain, -1);
  EXPECT_EQ(servo.offset, 2);
  EXPECT_EQ(servo.PositionOf(8), 1500);
  EXPECT_EQ(servo.min, 1150);
  EXPECT_EQ(servo.max, 1850);
  EXPECT_EQ(servo.neutral, 1400);
  EXPECT_EQ(servo.dead_band, 3);
  EXPECT_EQ(servo.backlash, 6);
  EXPECT_EQ(servo.max_speed_per_s, 4000);
  EXPECT_EQ(servo.max_acceleration_per_s2, 60000);
  EXPECT_EQ(servo.crawl_speed_per_s, 250);
  EXPECT_EQ(servo.limp_after, seconds(20));
}

TEST(LoadServoRig, WhatIsNotSaidFollowsFromTheMapAndTheRig) {
  const Servo servo = Load(R"(
[[servo]]
name = "jaw"
bus = "head"
id = 0
from = { "jaw.pitch" = 1 }
map = [[0, 2000], [20, 1000]]
max_speed = 4000
)")
                          .servos[0];
  EXPECT_EQ(servo.min, 1000);
  EXPECT_EQ(servo.max, 2000);
  EXPECT_EQ(servo.neutral, 1750) << "of jaw.pitch's neutral, 5";
  EXPECT_FLOAT_EQ(servo.dead_band, 5);
  EXPECT_EQ(servo.backlash, 0);
  EXPECT_EQ(servo.max_acceleration_per_s2, 0);
  EXPECT_EQ(servo.crawl_speed_per_s, 400);
  EXPECT_EQ(servo.limp_after, Duration::zero());
}

TEST(LoadServoRig, AServoThatNoChannelMovesNeedsItsLimitsOnly) {
  const Servo servo = Load(
                          "[[servo]]\nname = \"bare\"\nbus = \"chain\"\nid = 253\nmin = 1000\n"
                          "max = 3000\nmax_speed = 500\n")
                          .servos[0];
  EXPECT_TRUE(servo.sources.empty());
  EXPECT_EQ(servo.neutral, 2000);
}

// Two servos, "lid" and "eye", both resting at 1500.
const char* const kLidAndEye = R"([[servo]]
name = "lid"
bus = "head"
id = 0
min = 1000
max = 2000
max_speed = 4000
[[servo]]
name = "eye"
bus = "head"
id = 1
min = 1000
max = 2000
max_speed = 4000
)";

TEST(LoadServoRig, ReadsRulesAndTheContract) {
  const ServoRig rig = Load(std::string(R"([servos]
fresh_ms = 100
hold_ms = 300
ease_ms = 1000
limp_ms = 2000
stop_torque_ms = 50
calm = 2.5
lead_ms = 15
[[linkage]]  # before its servos: order does not matter
name = "lid_clears_eye"
yields = "lid"
other = "eye"
relation = "at_most"
gain = -0.5
offset = 2300
)") + kLidAndEye);
  EXPECT_EQ(rig.contract.fresh, milliseconds(100));
  EXPECT_EQ(rig.contract.hold, milliseconds(300));
  EXPECT_EQ(rig.contract.ease, milliseconds(1000));
  EXPECT_EQ(rig.contract.limp, milliseconds(2000));
  EXPECT_EQ(rig.contract.stop_torque, milliseconds(50));
  EXPECT_EQ(rig.following.calm, 2.5F);
  EXPECT_EQ(rig.following.lead, milliseconds(15));
  ASSERT_EQ(rig.linkages.size(), 1U);
  const servo::Linkage& linkage = rig.linkages[0];
  EXPECT_EQ(linkage.name.view(), "lid_clears_eye");
  EXPECT_EQ(linkage.yields, 0);
  EXPECT_EQ(linkage.other, 1);
  EXPECT_EQ(linkage.relation, Relation::kAtMost);
  EXPECT_EQ(linkage.gain, -0.5F);
  EXPECT_EQ(linkage.offset, 2300);
}

struct Row {
  const char* text;
  const char* complaint;
};

TEST(LoadServoRig, SaysWhatIsWrongWithAServo) {
  // Keys in front of these: line 6 is [[servo]], 7 name, 8 bus, 9 id, 10 max_speed.
  const Row table[] = {
      {"map = [[0, 1000], [1, 2000]]\nfrom = { \"jaw.pich\" = 1 }",
       "F:12:10: servo[0].from: no channel \"jaw.pich\" in this rig; did you mean \"jaw.pitch\"?"},
      {"from = { \"jaw.pitch\" = 1 }",
       "F:6:1: servo[0]: \"map\" is missing: from the sum to "
       "positions, as [[0, 1000], [1, 2000]]"},
      {"map = [[0, 1000]]",
       "F:11:7: servo[0].map: needs two points at least, as [[0, 1000], [1, 2000]]"},
      {"map = [[0, 1000], [1, 1500], [1, 2000]]",
       "F:11:30: servo[0].map: the point at 1 comes after the one at 1; points go from left to "
       "right"},
      {"map = [[0, 1000], [1, 1500], [2, 1400]]",
       "F:11:30: servo[0].map: turns around at 1500; positions rise all the way or fall all the "
       "way"},
      {"map = [[0, 1000], [1, 200000]]",
       "F:11:19: servo[0].map: 200000 is no position of a servo; expected microseconds, as 1500, "
       "or counts"},
      {"map = [[0, 1500], [1, 1500]]",
       "F:11:7: servo[0].map: stays at 1500; expected two positions at least"},
      {"min = 1000",
       "F:6:1: servo[0]: \"max\" is missing: the highest position, in microseconds "
       "or counts"},
      {"min = 2000\nmax = 1000", "F:11:7: servo[0].min: min, 2000, is not below max, 1000"},
      {"min = 1000\nmax = 2000\nneutral = 999",
       "F:13:11: servo[0].neutral: 999 is outside min to max, 1000 to 2000"},
      {"min = 1000\nmax = 2000\ndead_band = 1001",
       "F:13:13: servo[0].dead_band: 1001 is wider than min to max"},
      {"min = 1000\nmax = 2000\nbacklash = -1",
       "F:13:12: servo[0].backlash: -1 is out of range; allowed: 0 to 100000"},
      {"min = 1000\nmax = 2000\ncrawl_speed = 4001",
       "F:13:15: servo[0].crawl_speed: 4001 is not above 0 and at most max_speed, 4000"},
      {"min = 1000\nmax = 2000\nlimp_after_s = -5",
       "F:13:16: servo[0].limp_after_s: -5 is out of range; allowed: 0 to 86400 s"},
      {"min = 1000\nmax = 2000\nspeed = 5", "F:13:1: unknown key \"servo[0].speed\""},
  };
  for (const Row& row : table) {
    const std::string text =
        "[[servo]]\nname = \"jaw\"\nbus = \"head\"\nid = 0\nmax_speed = 4000\n" +
        std::string(row.text) + "\n";
    EXPECT_THAT(Complaint(text), HasSubstr(row.complaint)) << row.text;
  }
}

TEST(LoadServoRig, SaysWhatIsMissingAllAtOnce) {
  const std::string complaint = Complaint("[[servo]]\n");
  for (const char* key : {"name", "bus", "id", "min", "max", "max_speed"}) {
    EXPECT_THAT(complaint, HasSubstr("F:6:1: servo[0]: \"" + std::string(key) + "\" is missing"));
  }
}

TEST(LoadServoRig, NamesAndAddressesAreThereOnce) {
  std::string again = kLidAndEye;
  EXPECT_EQ(Complaint(again + Replaced(kLidAndEye, "head", "neck")),
            "F:21:8: servo[2].name: a second servo \"lid\"; every name may be there once\n"
            "F:28:8: servo[3].name: a second servo \"eye\"; every name may be there once");
  EXPECT_EQ(Complaint(Replaced(again, "id = 1", "id = 0")),
            "F:16:6: servo[1].id: 0 of bus \"head\" is \"lid\" already; every servo has an id of "
            "its own");
}

TEST(LoadServoRig, SaysWhatIsWrongWithARule) {
  // Line 20 is [[linkage]], 21 name, 22 yields.
  const Row table[] = {
      {"other = \"eyes\"\nrelation = \"at_least\"",
       "F:23:9: linkage[0].other: no servo \"eyes\" in this rig; did you mean \"eye\"?"},
      {"other = \"lid\"\nrelation = \"at_least\"",
       "F:23:9: linkage[0].other: is the servo that yields; a rule is between two"},
      {"other = \"eye\"\nrelation = \"above\"",
       "F:24:12: linkage[0].relation: \"above\" is none of \"at_least\", \"at_most\""},
      {"other = \"eye\"",
       "F:20:1: linkage[0]: \"relation\" is missing: \"at_least\" or \"at_most\""},
      {"other = \"eye\"\nrelation = \"at_least\"\noffset = 100",
       "F:24:12: linkage[0].relation: is broken at neutral: \"lid\" rests at 1500 and must be at "
       "least 1600"},
      {"other = \"eye\"\nrelation = \"at_least\"\nofset = 100",
       "F:25:1: unknown key \"linkage[0].ofset\"; did you mean \"offset\"?"},
  };
  for (const Row& row : table) {
    const std::string text = std::string(kLidAndEye) +
                             "[[linkage]]\nname = \"rule\"\nyields = \"lid\"\n" + row.text + "\n";
    EXPECT_EQ(Complaint(text), row.complaint) << row.text;
  }
}

TEST(LoadServoRig, SaysWhatIsWrongWithTheContract) {
  EXPECT_EQ(Complaint("[servos]\nhold_ms = -1\nlead_ms = 101\neas_ms = 3\n"),
            "F:7:11: servos.hold_ms: -1 is out of range; allowed: 0 to 60000 ms\n"
            "F:8:11: servos.lead_ms: 101 is out of range; allowed: 0 to 100 ms\n"
            "F:9:1: unknown key \"servos.eas_ms\"; did you mean \"ease_ms\"?");
}

TEST(LoadServoRig, MoreThanFitIsAProblem) {
  std::string text;
  for (std::size_t i = 0; i <= kMaxServos; ++i) {
    text += "[[servo]]\nname = \"s" + std::to_string(i) +
            "\"\nbus = \"head\"\nid = " + std::to_string(i) +
            "\nmin = 1000\nmax = 2000\nmax_speed = 1\n";
  }
  EXPECT_THAT(Complaint(text), HasSubstr("too many servos; the most is 64"));
}

// So that nobody copies an example that does not work.
TEST(LoadServoRig, TheExampleOfTheReadmeFitsOtto) {
  const std::filesystem::path source(FACEWIRE_SOURCE_DIR);
  const std::string readme = Scratch::Read(source / "app/README.md");
  const std::size_t begin = readme.find("    [[servo]]");
  ASSERT_NE(begin, std::string::npos);
  const std::string example = readme.substr(begin, readme.find("\n\n|", begin) - begin);
  const Scratch scratch;
  const auto file =
      scratch.Write("rig.toml", Scratch::Read(source / "app/share/otto.toml") + "\n" + example);
  const ServoRig rig = LoadServoRig(file, LoadRig(file));
  EXPECT_EQ(rig.servos.size(), 3U);
  EXPECT_EQ(rig.linkages.size(), 1U);
}

TEST(LoadRig, AMisspelledTableIsStillUnknown) {
  EXPECT_THAT(Complaint("[[servoo]]\nname = \"x\"\n"),
              HasSubstr("F:6:3: unknown key \"servoo\"; did you mean \"servos\"?"));
}

}  // namespace
}  // namespace facewire::app
