#include "tools/facewire/rig/rig_import.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <random>
#include <string>

#include "app/error.h"
#include "app/profile_file.h"
#include "app/rig_file.h"
#include "tests/tools/facewire/rig/made_character.h"
#include "tools/facewire/rig/shape_names.h"

namespace facewire::tools::rig {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

// As facewired --check reads it: with the signals of the default profile.
Rig Load(const std::string& toml) {
  static int count = 0;
  const std::string path = testing::TempDir() + "/rig_import_" + std::to_string(::getpid()) + "_" +
                           std::to_string(count++) + ".toml";
  std::ofstream(path) << toml;
  static const std::vector<std::string> kSignals = [] {
    std::vector<std::string> signals;
    for (const ShortName& name : app::ReadTrainingSet(FACEWIRE_AVERAGE_PROFILE).signals)
      signals.emplace_back(name.view());
    return signals;
  }();
  const std::filesystem::path file(path);
  try {
    const Rig rig = app::LoadRig(file, &kSignals);
    std::filesystem::remove(file);
    return rig;
  } catch (const app::BadInput& problem) {
    std::filesystem::remove(file);
    throw;
  }
}

const Channel& ChannelOf(const Rig& rig, std::string_view name) {
  const auto index = rig.FindChannel(name);
  if (!index) throw std::runtime_error("no channel " + std::string(name));
  return rig.channels[*index];
}

float GainOf(const Channel& channel, std::string_view signal) {
  for (const Drive& drive : channel.drives)
    if (drive.signal.view() == signal) return drive.gain;
  return 0;
}

const facewire::Bone& BoneOf(const Rig& rig, std::string_view name) {
  for (const facewire::Bone& bone : rig.bones)
    if (bone.name.view() == name) return bone;
  throw std::runtime_error("no bone " + std::string(name));
}

std::string ComplaintOf(const std::string& bytes) {
  try {
    ImportRig(bytes, "head.glb");
  } catch (const app::BadInput& error) {
    return error.what();
  }
  return "nothing";
}

TEST(RigImport, MatchesEveryArkitShapeThatLandmarksShow) {
  const ImportedRig imported = ImportRig(ArkitCharacter().Glb(), "head.glb");
  const Rig rig = Load(imported.toml);
  EXPECT_EQ(rig.name.view(), "head");
  for (const std::string& shape : ArkitShapes())
    EXPECT_EQ(rig.FindChannel(shape).has_value(), shape != UnseenShape()) << shape;
  EXPECT_THAT(imported.summary, AllOf(HasSubstr("51 of 52 shown"), HasSubstr("lacks: tongueOut")));
}

TEST(RigImport, ReadsTheTextFormToo) {
  const MadeCharacter character = ArkitCharacter();
  EXPECT_EQ(ImportRig(character.Text(), "head.gltf").summary,
            ImportRig(character.Glb(), "head.glb").summary);
}

TEST(RigImport, LeavesStillWhatAShapeMovesAlready) {
  const ImportedRig imported = ImportRig(ArkitCharacter().Glb(), "head.glb");
  const Rig rig = Load(imported.toml);
  EXPECT_FALSE(rig.FindChannel("LeftEye.yaw"));  // eyeLookInLeft and its like turn the eye
  EXPECT_THAT(imported.toml, HasSubstr("# yaw = {"));
  // Head and neck share what the head turns.
  EXPECT_FLOAT_EQ(GainOf(ChannelOf(rig, "Head.yaw"), "head.yaw") +
                      GainOf(ChannelOf(rig, "Neck.yaw"), "head.yaw"),
                  1);
}

TEST(RigImport, NamesAShapeThatIsThereAndMovesNothing) {
  MadeCharacter character;
  character.Mesh("face", {"jawOpen", "eyeBlinkLeft"}, {"eyeBlinkLeft"});
  const ImportedRig imported = ImportRig(character.Glb(), "head.glb");
  EXPECT_FALSE(Load(imported.toml).FindChannel("eyeBlinkLeft"));
  EXPECT_THAT(imported.summary, HasSubstr("eyeBlinkLeft is there, but moves no vertex"));
}

TEST(RigImport, KnowsUsualSpellingsAndSynonyms) {
  MadeCharacter character;
  character.Mesh("face", {"eyeBlink_L", "EyeBlinkRight", "Face.M_F00_000_00_Fcl_MTH_A", "smile.L",
                          "mouth_smile_r", "blendShape1.browInnerUp", "viseme_U", "jawleft"});
  const ImportedRig imported = ImportRig(character.Glb(), "head.glb");
  const Rig rig = Load(imported.toml);
  EXPECT_EQ(GainOf(ChannelOf(rig, "eyeBlink_L"), "eyeBlinkLeft"), 1);
  EXPECT_EQ(GainOf(ChannelOf(rig, "EyeBlinkRight"), "eyeBlinkRight"), 1);
  EXPECT_EQ(GainOf(ChannelOf(rig, "Face.M_F00_000_00_Fcl_MTH_A"), "jawOpen"), 1);
  EXPECT_EQ(GainOf(ChannelOf(rig, "smile.L"), "mouthSmileLeft"), 1);
  EXPECT_EQ(GainOf(ChannelOf(rig, "mouth_smile_r"), "mouthSmileRight"), 1);
  EXPECT_EQ(GainOf(ChannelOf(rig, "blendShape1.browInnerUp"), "browInnerUp"), 1);
  EXPECT_EQ(GainOf(ChannelOf(rig, "viseme_U"), "mouthPucker"), 1);
  EXPECT_EQ(GainOf(ChannelOf(rig, "jawleft"), "jawLeft"), 1);
}

TEST(RigImport, GivesASignalToTheSurestShapeOnly) {
  MadeCharacter character;
  character.Mesh(
      "face", {"Blink", "Blink_L", "eyeBlinkLeft", "eyeBlinkRight", "cheekPuff_L", "cheekPuff_R"});
  const ImportedRig imported = ImportRig(character.Glb(), "head.glb");
  const Rig rig = Load(imported.toml);
  EXPECT_FALSE(rig.FindChannel("Blink"));
  EXPECT_FALSE(rig.FindChannel("Blink_L"));
  EXPECT_THAT(imported.toml, HasSubstr("Blink_L is not used: eyeBlinkLeft shows the same"));
  // Two halves of one signal are no rivals.
  EXPECT_TRUE(rig.FindChannel("cheekPuff_L") && rig.FindChannel("cheekPuff_R"));
}

TEST(RigImport, TurnsVrm0AroundAndMakesDrivesOfItsExpressions) {
  const ImportedRig imported = ImportRig(Vrm0Character().Glb(), "puppet.vrm");
  const Rig rig = Load(imported.toml);
  EXPECT_EQ(rig.name.view(), "Old_Puppet");
  EXPECT_NEAR(BoneOf(rig, "LeftEye").rest_cm.x, 3.2, 1e-3);
  EXPECT_NEAR(BoneOf(rig, "LeftEye").rest_cm.y, 160, 1e-3);
  EXPECT_NEAR(BoneOf(rig, "LeftEye").rest_cm.z, 3, 1e-3);
  EXPECT_EQ(GainOf(ChannelOf(rig, "Close_L"), "eyeBlinkLeft"), 1);
  EXPECT_FALSE(rig.FindChannel("Close"));  // it would close them twice
  EXPECT_EQ(GainOf(ChannelOf(rig, "A"), "jawOpen"), 1);
  EXPECT_FLOAT_EQ(GainOf(ChannelOf(rig, "MouthWide"), "jawOpen"), 0.3F);
  EXPECT_FLOAT_EQ(GainOf(ChannelOf(rig, "Grin"), "mouthSmileLeft"), 0.4F);
  EXPECT_TRUE(rig.FindChannel("LeftEye.yaw"));  // it says that it looks by bones
  EXPECT_THAT(imported.summary, AllOf(HasSubstr("VRM 0"), HasSubstr("browInnerUp")));
}

TEST(RigImport, AddsUpTheExpressionsOfVrm1) {
  const ImportedRig imported = ImportRig(Vrm1Character().Glb(), "puppet.vrm");
  const Rig rig = Load(imported.toml);
  EXPECT_GT(BoneOf(rig, "LeftEye").rest_cm.x, 0);
  EXPECT_FLOAT_EQ(GainOf(ChannelOf(rig, "m0"), "eyeBlinkRight"), 0.5F);
  EXPECT_FLOAT_EQ(GainOf(ChannelOf(rig, "m2"), "jawOpen"), 0.25F);
  EXPECT_FLOAT_EQ(GainOf(ChannelOf(rig, "m2"), "mouthPucker"), 0.75F);
  EXPECT_FLOAT_EQ(GainOf(ChannelOf(rig, "m3"), "eyeLookOutLeft"), 0.5F);
  EXPECT_FLOAT_EQ(GainOf(ChannelOf(rig, "m4"), "cheekPuff"), 0.5F);
  EXPECT_FALSE(rig.FindChannel("LeftEye.yaw"));
  EXPECT_THAT(imported.summary, HasSubstr("VRM 1"));
}

TEST(RigImport, FindsBonesByNameAndByPlace) {
  const ImportedRig imported = ImportRig(BonesCharacter().Glb(), "bones.glb");
  const Rig rig = Load(imported.toml);
  EXPECT_EQ(GainOf(ChannelOf(rig, "Jaw.pitch"), "jawOpen"), 22);
  EXPECT_EQ(BoneOf(rig, "mouth_corner.L").landmark, 291);
  EXPECT_EQ(BoneOf(rig, "chin").landmark, 152);
  EXPECT_EQ(BoneOf(rig, "brow_inner_R").landmark, 107);
  EXPECT_EQ(BoneOf(rig, "fx17").landmark, 1);
  EXPECT_THAT(imported.toml, HasSubstr("by position: "));
  EXPECT_EQ(GainOf(ChannelOf(rig, "eyelid_upper_L.pitch"), "eyeBlinkLeft"), 45);
  EXPECT_TRUE(rig.FindChannel("eyelid_upper_R.y"));
  EXPECT_TRUE(rig.FindChannel("LeftEye.yaw"));
  for (const facewire::Bone& bone : rig.bones)
    EXPECT_THAT(std::string(bone.name.view()), AllOf(Not("LeftHand"), Not("Hair_01"), Not("fx18")));
  EXPECT_THAT(imported.toml, HasSubstr("fx18"));
}

TEST(RigImport, JudgesTheUnitByTheEyes) {
  MadeCharacter character;
  const int head = character.Bone("head", {0, 150, 0});
  character.Bone("eye.L", {3.1F, 160, 3}, head);
  character.Bone("eye.R", {-3.1F, 160, 3}, head);
  EXPECT_NEAR(BoneOf(Load(ImportRig(character.Glb(), "cm.glb").toml), "eye.L").rest_cm.x, 3.1,
              1e-3);
  EXPECT_NEAR(BoneOf(Load(ImportRig(character.Glb(), "mm.glb", 0.1).toml), "eye.L").rest_cm.x, 0.31,
              1e-3);
}

TEST(RigImport, RefusesABoneThatARigCannotHold) {
  MadeCharacter character;
  character.Bone("jaw", {0, 11, 0});
  EXPECT_THAT(ComplaintOf(character.Glb()), HasSubstr("head.glb: jaw is more than 10 m"));
}

TEST(RigImport, LeavesStillWhatTheJawCarries) {
  MadeCharacter character;
  const int head = character.Bone("head", {0, 1.5F, 0});
  const int jaw = character.Bone("jaw", {0, 1.5F, 0}, head);
  character.Bone("lower_lip", {0, 1.48F, 0.08F}, jaw);
  character.Bone("upper_lip", {0, 1.5F, 0.08F}, head);
  const ImportedRig imported = ImportRig(character.Glb(), "head.glb");
  const Rig rig = Load(imported.toml);
  EXPECT_TRUE(rig.FindChannel("upper_lip.y"));
  EXPECT_FALSE(rig.FindChannel("lower_lip.y"));
  EXPECT_THAT(imported.toml, HasSubstr("Moved by the bone jaw already"));
}

TEST(RigImport, ShortensNamesAndTellsEqualOnesApart) {
  MadeCharacter character;
  const std::string name = "a name that is much longer than a rig allows: eyeBlinkLeft";
  character.Mesh("face", {name, "jaw Open", "eyeBlinkRight"});
  const ImportedRig imported = ImportRig(character.Glb(), "x.glb");
  const Rig rig = Load(imported.toml);
  EXPECT_TRUE(rig.FindChannel("jaw_Open"));
  EXPECT_THAT(imported.toml, HasSubstr("in the file: " + name));
}

TEST(RigImport, SaysWhenThereIsNoFace) {
  MadeCharacter character;
  character.Bone("Wheel", {0, 0, 0});
  character.Mesh("car", {"dented"});
  EXPECT_THAT(ComplaintOf(character.Glb()), HasSubstr("nothing of a face"));
}

TEST(RigImport, SaysWhatIsWrongWithAFile) {
  const std::string good = ArkitCharacter().Glb();
  EXPECT_THAT(ComplaintOf(good.substr(0, good.size() - 1)), HasSubstr("is cut off"));
  EXPECT_THAT(ComplaintOf(""), HasSubstr("is no glTF"));
  EXPECT_THAT(ComplaintOf("Kaydara FBX Binary"), HasSubstr("Blender"));
  EXPECT_THAT(ComplaintOf("{\"asset\":{\"version\":\"1.0\"}}"), HasSubstr("glTF 2"));
  EXPECT_THAT(ComplaintOf("{\"asset\":"), HasSubstr("JSON is wrong at byte"));
  MadeCharacter circle = BonesCharacter();
  circle.gltf()["nodes"][2]["children"].push_back(0);
  EXPECT_THAT(ComplaintOf(circle.Glb()), HasSubstr("ancestors"));
  MadeCharacter nowhere = Vrm0Character();
  nowhere
      .gltf()["extensions"]["VRM"]["blendShapeMaster"]["blendShapeGroups"][0]["binds"][0]["index"] =
      99;
  EXPECT_THAT(
      ComplaintOf(nowhere.Glb()),
      HasSubstr("head.glb: VRM.blendShapeMaster.blink_l: there is no morph target 99 of 6"));
}

// Whatever happens to a file: a rig that loads, or one line.
void Try(const std::string& bytes) {
  try {
    Load(ImportRig(bytes, "head.glb").toml);
  } catch (const app::BadInput& error) {
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
    EXPECT_THAT(error.what(), testing::StartsWith("head.glb: "));
  }
}

TEST(RigImport, TakesAnyDamageWithOneLine) {
  std::mt19937 random(7);
  const auto below = [&](std::size_t end) {
    return std::uniform_int_distribution<std::size_t>(0, end - 1)(random);
  };
  for (const MadeCharacter& character :
       {Vrm0Character(), Vrm1Character(), BonesCharacter(), ArkitCharacter()}) {
    for (const std::string& good : {character.Glb(), character.Text()}) {
      for (int round = 0; round < 500; ++round) {
        std::string bytes = good;
        if (round % 5 == 0) bytes.resize(below(bytes.size()));
        for (std::size_t hits = below(4); hits > 0 && !bytes.empty(); --hits)
          bytes[below(bytes.size())] = static_cast<char>(below(256));
        if (round % 3 == 0 && bytes.size() > 40) {  // one piece of the file in another's place
          const std::size_t length = below(20);
          bytes.replace(below(bytes.size() - 20), length, good.substr(below(good.size()), length));
        }
        Try(bytes);
      }
    }
  }
}

// Damage that leaves the JSON whole: any value replaced by any other.
TEST(RigImport, TakesAnyWrongValueWithOneLine) {
  std::mt19937 random(8);
  const nlohmann::json wrong[] = {nullptr,
                                  true,
                                  -1,
                                  1e300,
                                  4294967296.0,
                                  "",
                                  "left",
                                  {},
                                  {{"a", 1}},
                                  nlohmann::json::array({1, 2}),
                                  0,
                                  0.5,
                                  "\x01\xC2\x85\n"};
  for (const MadeCharacter& character : {Vrm0Character(), Vrm1Character(), BonesCharacter()}) {
    const nlohmann::json flat = nlohmann::json::parse(character.Text()).flatten();
    std::vector<std::string> places;
    for (const auto& entry : flat.items())
      for (std::string place = entry.key(); !place.empty(); place.resize(place.rfind('/')))
        places.push_back(place);
    for (int round = 0; round < 1500; ++round) {
      nlohmann::json gltf = nlohmann::json::parse(character.Text());
      const std::string& place =
          places[std::uniform_int_distribution<std::size_t>(0, places.size() - 1)(random)];
      gltf[nlohmann::json::json_pointer(place)] =
          wrong[std::uniform_int_distribution<std::size_t>(0, std::size(wrong) - 1)(random)];
      Try(gltf.dump());
    }
  }
}

}  // namespace
}  // namespace facewire::tools::rig
