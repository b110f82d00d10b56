#ifndef FACEWIRE_TOOLS_FACEWIRE_RIG_GLTF_JSON_H_
#define FACEWIRE_TOOLS_FACEWIRE_RIG_GLTF_JSON_H_

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace facewire::tools::rig {

// The JSON of a glTF 2.0 file: of a .glb or .vrm (the container, whose chunks must be whole) or of
// a .gltf. Vertices and pictures are not looked at. Throws BadInput, one line that begins with
// `source`: neither of the two, cut off, damaged, JSON that is none, not glTF 2.
nlohmann::json ParseGltf(std::string_view bytes, const std::string& source);

// The bytes of a file. Throws BadInput when it cannot be read.
std::string ReadBytes(const std::string& path);

}  // namespace facewire::tools::rig

#endif  // FACEWIRE_TOOLS_FACEWIRE_RIG_GLTF_JSON_H_
