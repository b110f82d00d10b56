#ifndef FACEWIRE_TOOLS_FACEWIRE_RIG_NAME_TABLES_H_
#define FACEWIRE_TOOLS_FACEWIRE_RIG_NAME_TABLES_H_

#include <nlohmann/json.hpp>

namespace facewire::tools::rig {

// What names mean: tools/names/shapes.json and bones.json, as they were when this was built. The
// page reads the same files. Parsed at every call; keep what you read.
nlohmann::ordered_json ShapeTable();
nlohmann::ordered_json BoneTable();

}  // namespace facewire::tools::rig

#endif  // FACEWIRE_TOOLS_FACEWIRE_RIG_NAME_TABLES_H_
