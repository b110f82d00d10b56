#include "app/rig_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/app/scratch.h"

namespace facewire::app {
namespace {

using ::testing::HasSubstr;

const std::vector<std::string> kSignals = {"jawOpen", "eyeBlinkLeft"};

std::string Complaint(const std::string& text) {
  const Scratch scratch;
  const auto file = scratch.Write("rig.toml", text);
  const std::string what = ProblemsOf([&] { (void)LoadRig(file, &kSignals); });
  return Replaced(what, file.string(), "F");
}

std::filesystem::path Otto() {
  return std::filesystem::path(FACEWIRE_SOURCE_DIR) / "app/share/otto.toml";
}

TEST(LoadRig, ReadsBonesAndParametersInOrder) {
  const Scratch scratch;
  const Rig rig = LoadRig(scratch.Write("rig.toml", R"(
name = "test"
[[bone]]
name = "jaw"
landmark = "chin"
rest_cm = [0, -9.5, 4]
pitch = { min = -1, max = 20, neutral = 1, max_speed = 100, max_acceleration = 900, drive = { jawOpen = 18, "head.pitch" = -0.5 } }
z = { min = -1, max = 1.5 }
[[parameter]]
name = "jawOpen"
[[parameter]]
name = "glow"
max = 255
drive = { eyeBlinkLeft = 255 }
)"),
                          &kSignals);
  EXPECT_EQ(rig.name.view(), "test");
  ASSERT_EQ(rig.bones.size(), 1U);
  EXPECT_EQ(rig.bones[0].name.view(), "jaw");
  EXPECT_EQ(rig.bones[0].landmark, 152);
  EXPECT_EQ(rig.bones[0].rest_cm, (Point3{0, -9.5F, 4}));
  ASSERT_EQ(rig.channels.size(), 4U);
  const Channel& z = rig.channels[0];
  EXPECT_EQ(z.name.view(), "jaw.z");
  EXPECT_EQ(z.kind, ChannelKind::kPositionZ);
  EXPECT_TRUE(z.drives.empty()) << "follows the landmark";
  const Channel& pitch = rig.channels[1];
  EXPECT_EQ(pitch.name.view(), "jaw.pitch");
  EXPECT_EQ(pitch.kind, ChannelKind::kPitch);
  EXPECT_EQ(pitch.bone, 0);
  EXPECT_FLOAT_EQ(pitch.min, -1);
  EXPECT_FLOAT_EQ(pitch.max, 20);
  EXPECT_FLOAT_EQ(pitch.neutral, 1);
  EXPECT_FLOAT_EQ(pitch.max_speed_per_s, 100);
  EXPECT_FLOAT_EQ(pitch.max_acceleration_per_s2, 900);
  ASSERT_EQ(pitch.drives.size(), 2U);
  EXPECT_EQ(pitch.drives[0].signal.view(), "jawOpen");
  EXPECT_FLOAT_EQ(pitch.drives[0].gain, 18);
  EXPECT_EQ(pitch.drives[1].signal.view(), "head.pitch");
  const Channel& open = rig.channels[2];
  EXPECT_EQ(open.bone, -1);
  EXPECT_FLOAT_EQ(open.max, 1);
  ASSERT_EQ(open.drives.size(), 1U) << "a parameter follows the signal of its name";
  EXPECT_EQ(open.drives[0].signal.view(), "jawOpen");
  EXPECT_FLOAT_EQ(rig.channels[3].drives[0].gain, 255);
}

TEST(LoadRig, ReadsHowAChannelAnswers) {
  const Scratch scratch;
  const Rig rig = LoadRig(scratch.Write("rig.toml", R"(
name = "test"
[[bone]]
name = "jaw"
landmark = "chin"
pitch = { min = 0, max = 20, gain = 1.5, bias = 0.5, knee = 0.25, curve = [[0, 0], [5, 2.5], [20, 20]], drive = { jawOpen = 18 } }
z = { min = -1, max = 1.5, gain = -2 }
[[parameter]]
name = "jawOpen"
knee = 0.05
[[parameter]]
name = "eyeBlinkLeft"
)"),
                          &kSignals);
  const Channel& pitch = rig.channels[*rig.FindChannel("jaw.pitch")];
  EXPECT_FLOAT_EQ(pitch.response.gain, 1.5F);
  EXPECT_FLOAT_EQ(pitch.response.bias, 0.5F);
  EXPECT_FLOAT_EQ(pitch.knee, 0.25F);
  ASSERT_EQ(pitch.response.curve.size(), 3U);
  EXPECT_FLOAT_EQ(pitch.response.curve[1].in, 5);
  EXPECT_FLOAT_EQ(pitch.response.curve[1].out, 2.5F);
  const Channel& z = rig.channels[*rig.FindChannel("jaw.z")];
  EXPECT_FLOAT_EQ(z.response.gain, -2);
  EXPECT_EQ(z.response.bias, 0);
  EXPECT_TRUE(z.response.curve.empty());
  EXPECT_FLOAT_EQ(z.knee, 0.1F) << "a bone runs softly to its end";
  EXPECT_FLOAT_EQ(rig.channels[*rig.FindChannel("jawOpen")].knee, 0.05F);
  const Channel& plain = rig.channels[*rig.FindChannel("eyeBlinkLeft")];
  EXPECT_EQ(plain.knee, 0) << "a blend shape reaches 1";
  EXPECT_EQ(plain.response.gain, 1);
}

struct Row {
  const char* text;
  const char* complaint;
};

TEST(LoadRig, SaysWhatIsWrongWhereAndWhatWouldBeRight) {
  const Row table[] = {
      {"[[parameter]]\nname = \"jawOpen\"\n",
       "F:1:1: \"name\" is missing: what the character is called"},
      {"name = \"r\"\n",
       "F:1:1: \"parameter\" is missing: a rig needs at least one [[bone]] with an axis, or one "
       "[[parameter]]"},
      {"name = \"r\"\n[[bone]]\nname = \"b\"\nlandmark = \"shin\"\n",
       "F:4:12: bone[0].landmark: no landmark \"shin\"; did you mean \"chin\"?"},
      {"name = \"r\"\n[[bone]]\nname = \"b\"\nlandmark = \"elbowjoint\"\n",
       "F:4:12: bone[0].landmark: no landmark \"elbowjoint\"; expected 0 to 477 or a name such as "
       "\"chin\""},
      {"name = \"r\"\n[[bone]]\nname = \"b\"\nlandmark = 478\n",
       "F:4:12: bone[0].landmark: 478 is out of range; allowed: 0 to 477"},
      {"name = \"r\"\n[[bone]]\nname = \"b\"\nlandmark = 478\nx = { min = -1, max = 1 }\n",
       "F:4:12: bone[0].landmark: 478 is out of range; allowed: 0 to 477"},
      {"name = \"r\"\n[[bone]]\nname = \"b\"\n[[bone]]\nname = \"b\"\n",
       "F:5:8: bone[1].name: a second bone \"b\"; every name may be there once"},
      {"name = \"r\"\n[[bone]]\nname = \"b c\"\n",
       "F:3:8: bone[0].name: \"b c\" is no name; expected 1 to 31 printable ASCII characters "
       "without spaces"},
      {"name = \"r\"\n[[bone]]\nname = \"b\"\nrest_cm = [0, 1]\n",
       "F:4:11: bone[0].rest_cm: is an array; expected an array of 3 numbers"},
      {"name = \"r\"\n[[bone]]\nname = \"b\"\npitch = { min = 2, max = 1, drive = { jawOpen = 1 } "
       "}\n",
       "F:4:17: bone[0].pitch.min: 2 is not below max, 1"},
      {"name = \"r\"\n[[bone]]\nname = \"b\"\npitch = { min = 1, max = 2, drive = { jawOpen = 1 } "
       "}\n",
       "F:4:9: bone[0].pitch.neutral: 0 is outside min to max, 1 to 2"},
      {"name = \"r\"\n[[bone]]\nname = \"b\"\npitch = { min = -1, max = 1 }\n",
       "F:4:9: bone[0].pitch: would never move; give it a drive, as drive = { jawOpen = 20 }"},
      {"name = \"r\"\n[[bone]]\nname = \"b\"\nx = { min = -1, max = 1 }\n",
       "F:4:5: bone[0].x: would never move; give the bone a landmark or a marker, or a drive here"},
      {"name = \"r\"\n[[parameter]]\nname = \"jawOpen\"\nmax = inf\n",
       "F:4:7: parameter[0].max: inf is out of range; allowed: -1e+06 to 1e+06"},
      {"name = \"r\"\n[[parameter]]\nname = \"jawOpen\"\nmaxspeed = 4\n",
       "F:4:1: unknown key \"parameter[0].maxspeed\"; did you mean \"max_speed\"?"},
      {"name = \"r\"\n[[parameter]]\nname = \"jawOpen\"\n[[parameter]]\nname = \"jawOpen\"\n",
       "F:5:8: parameter[1].name: a second channel \"jawOpen\"; every name may be there once"},
      {"name = \"r\"\n[[parameter]]\nname = \"jawOpn\"\n",
       "F:3:8: parameter[0].drive: no signal \"jawOpn\" in the profile, nor of the head; did you "
       "mean \"jawOpen\"?"},
      {"name = \"r\"\n[[parameter]]\nname = \"p\"\ndrive = { \"head.pich\" = 1 }\n",
       "F:4:11: parameter[0].drive: no signal \"head.pich\" in the profile, nor of the head; did "
       "you mean \"head.pitch\"?"},
      {"name = \"r\"\n[[parameter]]\nname = \"jawOpen\"\ngain = 1e4\n",
       "F:4:8: parameter[0].gain: 10000 is out of range; allowed: -1000 to 1000"},
      {"name = \"r\"\n[[parameter]]\nname = \"jawOpen\"\nknee = 0.6\n",
       "F:4:8: parameter[0].knee: 0.6 is out of range; allowed: 0 to 0.5"},
      {"name = \"r\"\n[[parameter]]\nname = \"jawOpen\"\nbias = 1.25\n",
       "F:4:8: parameter[0].bias: takes a neutral face to 1.25, outside min to max, 0 to 1"},
      {"name = \"r\"\n[[parameter]]\nname = \"jawOpen\"\ncurve = [[0, -0.5], [1, 1]]\n",
       "F:4:9: parameter[0].curve: takes a neutral face to -0.5, outside min to max, 0 to 1"},
      {"name = \"r\"\n[[parameter]]\nname = \"jawOpen\"\ncurve = 2\n",
       "F:4:9: parameter[0].curve: is a number; expected an array of pairs, as [[0, 0], [1, 1]]"},
      {"name = \"r\"\n[[parameter]]\nname = \"jawOpen\"\ncurve = [[0, 0], [1]]\n",
       "F:4:18: parameter[0].curve[1]: expected a pair of numbers, as [0, 0]"},
      {"name = \"r\"\n[[parameter]]\nname = \"jawOpen\"\ncurve = [[0, 0], [1, nan]]\n",
       "F:4:22: parameter[0].curve[1][1]: nan is out of range; allowed: -1e+06 to 1e+06"},
      {"name = \"r\"\n[[parameter]]\nname = \"jawOpen\"\ncurve = [[0, 0]]\n",
       "F:4:9: parameter[0].curve: needs two points at least, as [[0, 0], [1, 1]]"},
      {"name = \"r\"\n[[parameter]]\nname = \"jawOpen\"\ncurve = [[0, 0], [1, 1], [1, 2]]\n",
       "F:4:26: parameter[0].curve: the point at 1 comes after the one at 1; points go from left "
       "to "
       "right"},
      {"name = \"r\"\n[[parameter]]\nname = \"jawOpen\"\ncurve = [[0, 1], [1, 0.5], [0, 9]]\n",
       "F:4:18: parameter[0].curve: falls from 1 to 0.5; a curve only rises, a negative gain turns "
       "the channel around"},
      {"name = \"r\"\n[[parameter]]\nname = \"jawOpen\"\n"
       "curve = [[0,0],[1,1],[2,2],[3,3],[4,4],[5,5],[6,6],[7,7],[8,8]]\n",
       "F:4:58: parameter[0].curve: too many points; the most is 8"},
      {"name = \"r\"\nparameter = 4\n",
       "F:2:13: parameter: is a number; expected tables "
       "([[parameter]])"},
  };
  for (const Row& row : table) EXPECT_EQ(Complaint(row.text), row.complaint) << row.text;
}

TEST(LoadRig, ABoneFollowsALandmarkOrAMarkerByItsName) {
  const Scratch scratch;
  const auto load = [&](const std::string& keys) {
    return LoadRig(scratch.Write("rig.toml", "name = \"r\"\n[[bone]]\nname = \"b\"\n" + keys +
                                                 "x = { min = -1, max = 1 }\n"))
        .bones[0];
  };
  const Bone marked = load("marker = \"RBRO1\"\n");
  EXPECT_EQ(marked.marker.view(), "RBRO1");
  EXPECT_EQ(marked.landmark, -1) << "no performer in front of a camera has it";
  const Bone landmark = load("marker = \"lm33\"\n");
  EXPECT_EQ(landmark.landmark, 33);
  EXPECT_TRUE(landmark.marker.empty());
  EXPECT_EQ(Complaint("name = \"r\"\n[[bone]]\nname = \"b\"\nlandmark = 3\nmarker = \"m\"\n"
                      "x = { min = -1, max = 1 }\n"),
            "F:5:10: bone[0].marker: the bone has a landmark too; give it one of them");
  EXPECT_THAT(Complaint("name = \"r\"\n[[bone]]\nname = \"b\"\nmarker = \"my marker\"\n"
                        "x = { min = -1, max = 1 }\n"),
              HasSubstr("\"my marker\" is no name"));
}

TEST(LoadRig, ReportsEveryProblemAtOnce) {
  const std::string what = Complaint(
      "name = \"r\"\n[[bone]]\nname = \"b\"\nlandmark = 999\n[[parameter]]\nname = \"q\"\n");
  EXPECT_THAT(what, HasSubstr("F:4:12: "));
  EXPECT_THAT(what, HasSubstr("\nF:6:8: "));
}

TEST(LoadRig, RefusesOneMoreThanTheCapacities) {
  std::string bones = "name = \"r\"\n";
  for (std::size_t i = 0; i < kMaxBones; ++i)
    bones += "[[bone]]\nname = \"b" + std::to_string(i) + "\"\n";
  EXPECT_EQ(Complaint(bones), "") << "exact fit";
  EXPECT_THAT(Complaint(bones + "[[bone]]\nname = \"c\"\n"),
              HasSubstr("too many bones; the most is 80"));
  std::string parameters = "name = \"r\"\n";
  for (std::size_t i = 0; i < kMaxChannels; ++i) {
    parameters += "[[parameter]]\nname = \"p" + std::to_string(i) + "\"\ndrive = { jawOpen = 1 }\n";
  }
  EXPECT_EQ(Complaint(parameters), "") << "exact fit";
  EXPECT_THAT(Complaint(parameters + "[[parameter]]\nname = \"jawOpen\"\n"),
              HasSubstr("too many channels; the most is 240"));
}

TEST(LoadRig, LetsAnySignalPassWithoutAProfile) {
  const Scratch scratch;
  const auto file = scratch.Write("rig.toml", "name = \"r\"\n[[parameter]]\nname = \"anything\"\n");
  EXPECT_EQ(LoadRig(file).channels.size(), 1U);
}

TEST(Otto, Loads) {
  const Rig rig = LoadRig(Otto());
  EXPECT_EQ(rig.name.view(), "otto");
  for (const char* name :
       {"jaw.pitch",      "upper_lid_L.pitch", "lower_lid_R.pitch", "brow_inner_L.y",
        "brow_outer_R.y", "lip_corner_L.x",    "upper_lip.y",       "lower_lip.y",
        "eye_L.yaw",      "eye_R.pitch",       "neck.pitch",        "neck.yaw",
        "neck.roll",      "jawOpen",           "mouthSmileLeft",    "mouthSmileRight",
        "mouthPucker",    "eyeBlinkLeft",      "eyeBlinkRight",     "browInnerUp",
        "browDownLeft",   "browDownRight"}) {
    EXPECT_TRUE(rig.FindChannel(name)) << name;
  }
}

// The comment in the file promises it: from rest to the end of the range under both limits.
TEST(Otto, ClosesItsUpperLidsAsFastAsABlink) {
  const Rig rig = LoadRig(Otto());
  for (const char* name : {"upper_lid_L.pitch", "upper_lid_R.pitch"}) {
    const Channel& lid = rig.channels[*rig.FindChannel(name)];
    const float way = lid.max - lid.neutral;
    const float v = lid.max_speed_per_s;
    const float a = lid.max_acceleration_per_s2;
    const float seconds = way >= v * v / a ? way / v + v / a : 2 * std::sqrt(way / a);
    EXPECT_LT(seconds, 0.075F) << name;
  }
}

// A soft knee would leave them open by a crack.
TEST(Otto, ClosesItsUpperLidsFully) {
  const Rig rig = LoadRig(Otto());
  for (const char* name : {"upper_lid_L.pitch", "upper_lid_R.pitch"}) {
    const Channel& lid = rig.channels[*rig.FindChannel(name)];
    EXPECT_EQ(lid.ValueOf(lid.drives[0].gain), lid.max) << name;
  }
}

TEST(Otto, IsTheSameOnBothSides) {
  const Rig rig = LoadRig(Otto());
  for (const Bone& left : rig.bones) {
    const std::string_view name = left.name.view();
    if (!name.ends_with("_L")) continue;
    const std::string mirrored = std::string(name.substr(0, name.size() - 1)) + "R";
    const Bone* right = std::find_if(rig.bones.begin(), rig.bones.end(),
                                     [&](const Bone& b) { return b.name.view() == mirrored; });
    ASSERT_NE(right, rig.bones.end()) << mirrored;
    EXPECT_EQ(right->rest_cm, (Point3{-left.rest_cm.x, left.rest_cm.y, left.rest_cm.z}));
  }
}

TEST(LandmarkByName, KnowsSidesAsThePersonsOwn) {
  EXPECT_EQ(LandmarkByName("chin"), 152);
  EXPECT_EQ(LandmarkByName("left_mouth_corner"), 291);
  EXPECT_EQ(LandmarkByName("right_mouth_corner"), 61);
  EXPECT_EQ(LandmarkByName("elbow"), std::nullopt);
}

}  // namespace
}  // namespace facewire::app
