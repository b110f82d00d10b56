#ifndef FACEWIRE_TOOLS_FACEWIRE_RIG_CHARACTER_H_
#define FACEWIRE_TOOLS_FACEWIRE_RIG_CHARACTER_H_

#include <cstddef>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/base/geometry.h"

// What a glTF file says about a character that matters to a rig, as it stands there: in the file's
// own unit and axes, under its own names.
namespace facewire::tools::rig {

struct CharacterNode {
  std::string name;
  int parent = -1;     // index of a node
  int depth = 0;       // nodes above it
  Point3 position{};   // of its origin in the scene, at rest
  bool joint = false;  // some skin hangs on it
};

// A morph target. Those of several meshes that share a name (face, teeth, brows) are one.
struct CharacterShape {
  std::string name;
  bool moves = false;  // some vertex, somewhere
};

// A VRM expression (VRM 0: blend-shape group): weights of shapes.
struct CharacterExpression {
  struct Bind {
    std::size_t shape = 0;
    double weight = 1;  // 0..1
  };
  std::string name;  // "blinkLeft", or the author's own
  std::vector<Bind> binds;
};

enum class Convention { kGltf, kVrm0, kVrm1 };

struct Character {
  Convention convention = Convention::kGltf;
  std::string name;  // may be empty
  std::vector<CharacterNode> nodes;
  std::vector<CharacterShape> shapes;
  std::vector<CharacterExpression> expressions;
  std::map<std::string, std::size_t> humanoid;  // VRM: "leftEye" to a node
  bool looks_by_bones = false;                  // VRM: the eyes' bones turn
  bool looks_by_shapes = false;                 // VRM: expressions move the gaze
};

// `gltf` as ParseGltf gives it. Throws BadInput, one line that begins with `source` and says where:
// indices of nothing, nodes in a circle, places that are no numbers.
Character ReadCharacter(const nlohmann::json& gltf, const std::string& source);

}  // namespace facewire::tools::rig

#endif  // FACEWIRE_TOOLS_FACEWIRE_RIG_CHARACTER_H_
