#ifndef FACEWIRE_TOOLS_GLTF_MODEL_H_
#define FACEWIRE_TOOLS_GLTF_MODEL_H_

#include <tiny_gltf.h>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/base/geometry.h"
#include "core/rig/rig.h"

// A rig as glTF nodes, meshes and a skin; animation.cc moves them. glTF's axes are those of the
// head frame (y up, the character faces +z); its unit is the metre.
namespace facewire::tools {

inline constexpr float kMetresPerCm = 0.01F;

// Appends arrays to a model's only buffer and describes them.
class BufferWriter {
 public:
  explicit BufferWriter(tinygltf::Model& model);

  // Index of an accessor over `values`, `type` (TINYGLTF_TYPE_...) by `type`. `bounds`: with its
  // least and greatest values, as positions and times must have them. `target`: 0, or what a GPU
  // binds it as.
  int Add(std::span<const float> values, int type, bool bounds = false, int target = 0);
  int Add(std::span<const std::uint16_t> indices);
  int Add(std::span<const std::uint8_t> joints);  // four by four

 private:
  int Append(std::span<const std::byte> bytes, std::size_t count, int type, int component,
             int target);

  tinygltf::Model& model_;
};

// Where the parts of a rig are in the model.
struct ModelNodes {
  int head = -1;
  int face = -1;           // has the morph targets; -1 when the rig has no parameters
  std::vector<int> bones;  // for each bone of the rig
};

// Adds everything but the animation.
ModelNodes AddCharacter(const Rig& rig, BufferWriter& buffer, tinygltf::Model& model);

// The rig's parameters, as indices of channels: one morph target each, in this order.
std::vector<std::size_t> ParametersOf(const Rig& rig);

// The weight of a parameter's morph target. A parameter that stays within -1..1 is its own weight;
// of any other, an angle say, it is the part of the way from the parameter's least to its greatest
// value, because importers cut weights off.
float MorphWeight(const Channel& parameter, float value);

}  // namespace facewire::tools

#endif  // FACEWIRE_TOOLS_GLTF_MODEL_H_
