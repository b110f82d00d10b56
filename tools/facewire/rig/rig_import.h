#ifndef FACEWIRE_TOOLS_FACEWIRE_RIG_RIG_IMPORT_H_
#define FACEWIRE_TOOLS_FACEWIRE_RIG_RIG_IMPORT_H_

#include <string>
#include <string_view>

namespace facewire::tools::rig {

struct ImportedRig {
  std::string toml;     // the rig file
  std::string summary;  // for a terminal
};

// From the bytes of a .glb, .gltf or .vrm. `source` names it in complaints and in the rig;
// `cm_per_unit` is its unit, 0 to judge it. Throws BadInput, one line: what is wrong with the file,
// or that nothing of a face was found in it.
ImportedRig ImportRig(std::string_view bytes, const std::string& source, double cm_per_unit = 0);

}  // namespace facewire::tools::rig

#endif  // FACEWIRE_TOOLS_FACEWIRE_RIG_RIG_IMPORT_H_
