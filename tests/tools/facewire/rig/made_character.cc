#include "tests/tools/facewire/rig/made_character.h"

#include <algorithm>

#include "tools/facewire/rig/shape_names.h"

namespace facewire::tools::rig {
namespace {

using nlohmann::json;

void AddWord(std::string& bytes, std::uint32_t word) {
  for (int i = 0; i < 4; ++i) bytes += static_cast<char>((word >> (8 * i)) & 0xFFU);
}

constexpr char kBinary[] = "sixteen bytes!!!";  // what a vertex is, nobody looks at

struct Person {
  int head = 0, left_eye = 0, right_eye = 0;
};

// `front` is 1 where the character faces +z.
Person AddPerson(MadeCharacter& character, float front) {
  const int hips = character.Bone("Hips", {0, 0.9F, 0});
  const int neck = character.Bone("Neck", {0, 1.45F, 0}, hips);
  Person person;
  person.head = character.Bone("Head", {0, 1.52F, 0}, neck);
  person.left_eye = character.Bone("LeftEye", {0.032F * front, 1.6F, 0.03F * front}, person.head);
  person.right_eye =
      character.Bone("RightEye", {-0.032F * front, 1.6F, 0.03F * front}, person.head);
  character.Bone("LeftHand", {0.6F * front, 1.3F, 0}, hips);
  character.Bone("Hair_01", {0, 1.64F, 0.06F * front}, person.head);
  return person;
}

}  // namespace

MadeCharacter::MadeCharacter() {
  gltf_ = {{"asset", {{"version", "2.0"}}},
           {"nodes", json::array()},
           {"meshes", json::array()},
           {"accessors", json::array()},
           {"buffers", json::array({{{"byteLength", sizeof(kBinary) - 1}}})}};
}

int MadeCharacter::Bone(const std::string& name, Point3 place, int parent) {
  const auto index = static_cast<int>(gltf_["nodes"].size());
  const Point3 from = parent < 0 ? Point3{} : places_[static_cast<std::size_t>(parent)];
  const Point3 local = place - from;
  json node{{"name", name}};
  node["translation"] = json::array({local.x, local.y, local.z});
  gltf_["nodes"].push_back(node);
  places_.push_back(place);
  if (parent >= 0) gltf_["nodes"][static_cast<std::size_t>(parent)]["children"].push_back(index);
  gltf_["skins"][0]["joints"].push_back(index);
  return index;
}

int MadeCharacter::Mesh(const std::string& name, const std::vector<std::string>& shapes,
                        const std::vector<std::string>& still) {
  json targets = json::array();
  for (const std::string& shape : shapes) {
    const bool moves = std::ranges::find(still, shape) == still.end();
    targets.push_back(json{{"POSITION", gltf_["accessors"].size()}});
    json accessor{{"count", 3}};
    accessor["min"] = json::array({0, 0, 0});
    accessor["max"] = json::array({0, moves ? 0.01 : 0.0, 0});
    gltf_["accessors"].push_back(accessor);
  }
  const auto index = static_cast<int>(gltf_["meshes"].size());
  json mesh{{"name", name}};
  mesh["primitives"][0]["targets"] = targets;
  mesh["extras"]["targetNames"] = shapes;
  gltf_["meshes"].push_back(mesh);
  gltf_["nodes"].push_back(json{{"name", name}, {"mesh", index}});
  places_.emplace_back();
  return index;
}

std::string MadeCharacter::Glb() const {
  std::string text = gltf_.dump();
  text.resize((text.size() + 3) / 4 * 4, ' ');
  std::string bytes;
  AddWord(bytes, 0x46546C67);
  AddWord(bytes, 2);
  AddWord(bytes, static_cast<std::uint32_t>(12 + 8 + text.size() + 8 + sizeof(kBinary) - 1));
  AddWord(bytes, static_cast<std::uint32_t>(text.size()));
  bytes += "JSON" + text;
  AddWord(bytes, sizeof(kBinary) - 1);
  bytes += std::string("BIN\0", 4) + kBinary;
  return bytes;
}

MadeCharacter ArkitCharacter() {
  MadeCharacter character;
  AddPerson(character, 1);
  character.Mesh("face", ArkitShapes());
  character.Mesh("teeth", {"jawOpen", "tongueOut"});
  return character;
}

MadeCharacter Vrm0Character() {
  MadeCharacter character;
  const Person person = AddPerson(character, -1);
  const int mesh =
      character.Mesh("Face", {"Close_L", "Close_R", "Close", "A", "MouthWide", "Grin"});
  const auto bind = [&](int index, int weight) {
    return json{{"mesh", mesh}, {"index", index}, {"weight", weight}};
  };
  const auto group = [](const char* preset, const json& binds) {
    return json{{"name", preset}, {"presetName", preset}, {"binds", binds}};
  };
  const auto human = [](const char* bone, int node) {
    return json{{"bone", bone}, {"node", node}};
  };
  character.gltf()["extensions"]["VRM"] = {
      {"meta", {{"title", "Old Puppet"}}},
      {"humanoid",
       {{"humanBones",
         {human("head", person.head), human("leftEye", person.left_eye),
          human("rightEye", person.right_eye)}}}},
      {"firstPerson", {{"lookAtTypeName", "Bone"}}},
      {"blendShapeMaster",
       {{"blendShapeGroups",
         {group("blink_l", json::array({bind(0, 100)})),
          group("blink_r", json::array({bind(1, 100)})),
          group("blink", json::array({bind(2, 100)})),
          group("a", json::array({bind(3, 100), bind(4, 30)})),
          group("joy", json::array({bind(5, 80)})), group("lookup", json::array()),
          group("neutral", json::array())}}}}};
  return character;
}

MadeCharacter Vrm1Character() {
  MadeCharacter character;
  const Person person = AddPerson(character, 1);
  character.Mesh("Face", {"m0", "m1", "m2", "m3", "m4"});
  const std::size_t face = character.gltf()["nodes"].size() - 1;
  const auto expression = [&](const std::vector<std::pair<int, double>>& binds) {
    json list = json::array();
    for (const auto& [index, weight] : binds)
      list.push_back(json{{"node", face}, {"index", index}, {"weight", weight}});
    return json{{"morphTargetBinds", list}};
  };
  character.gltf()["extensions"]["VRMC_vrm"] = {
      {"specVersion", "1.0"},
      {"meta", {{"name", "New Puppet"}}},
      {"humanoid",
       {{"humanBones",
         {{"head", {{"node", person.head}}},
          {"leftEye", {{"node", person.left_eye}}},
          {"rightEye", {{"node", person.right_eye}}}}}}},
      {"lookAt", {{"type", "expression"}}},
      {"expressions",
       {{"preset",
         {{"blink", expression({{0, 1.0}})},
          {"aa", expression({{1, 1.0}, {2, 0.25}})},
          {"ou", expression({{2, 0.75}})},
          {"lookLeft", expression({{3, 1.0}})}}},
        {"custom", {{"cheekPuff", expression({{4, 0.5}})}}}}}};
  return character;
}

MadeCharacter BonesCharacter() {
  MadeCharacter character;
  const int head = AddPerson(character, 1).head;
  const auto bone = [&](const char* name, float x, float y, float z) {
    // In cm from between the eyes of a person, whose eyeballs the others are measured from.
    character.Bone(name, {0.01F * x, 1.6F + 0.01F * (y - 2.6F), 0.03F + 0.01F * (z - 2.6F)}, head);
  };
  bone("Jaw", 0, 0, -3);
  bone("mouth_corner.L", 2.46F, -4.34F, 4.28F);
  bone("mouth_corner.R", -2.46F, -4.34F, 4.28F);
  bone("lip_upper", 0, -3.41F, 5.98F);
  bone("chin", 0, -9.4F, 4.26F);
  bone("brow_inner_L", 1.4F, 5.01F, 5.32F);
  bone("brow_inner_R", -1.4F, 5.01F, 5.32F);
  bone("eyelid_upper_L", 3.18F, 2.6F, 2.6F);     // at the eye: turns
  bone("eyelid_upper_R", -3.18F, 2.96F, 3.88F);  // at its edge: slides
  bone("fx17", 0.05F, -1.1F, 7.4F);              // the tip of the nose
  bone("fx18", 0, 1, -8);                        // inside the skull
  return character;
}

}  // namespace facewire::tools::rig
