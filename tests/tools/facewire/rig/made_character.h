#ifndef FACEWIRE_TESTS_TOOLS_FACEWIRE_RIG_MADE_CHARACTER_H_
#define FACEWIRE_TESTS_TOOLS_FACEWIRE_RIG_MADE_CHARACTER_H_

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/base/geometry.h"

namespace facewire::tools::rig {

// A character file made of code: as much glTF as a rig is read from, in the file's own unit.
class MadeCharacter {
 public:
  MadeCharacter();

  // Adds a joint and returns its node; `place` is where it is in the scene.
  int Bone(const std::string& name, Point3 place, int parent = -1);
  // Adds a mesh with these morph targets, on a node of its own; returns the mesh. Each moves, but
  // for those named in `still`.
  int Mesh(const std::string& name, const std::vector<std::string>& shapes,
           const std::vector<std::string>& still = {});

  nlohmann::json& gltf() { return gltf_; }
  std::string Text() const { return gltf_.dump(); }
  std::string Glb() const;

 private:
  nlohmann::json gltf_;
  std::vector<Point3> places_;
};

// A puppet of four conventions, in metres: head, neck and eyes of a person's size.
MadeCharacter ArkitCharacter();  // every ARKit shape by its name
MadeCharacter Vrm0Character();   // faces -z; expressions combine shapes
MadeCharacter Vrm1Character();
MadeCharacter BonesCharacter();  // no shapes: jaw, lids, brows, lips, and bones of no known name

}  // namespace facewire::tools::rig

#endif  // FACEWIRE_TESTS_TOOLS_FACEWIRE_RIG_MADE_CHARACTER_H_
