#include "tools/facewire/rig/rig_import.h"

#include <filesystem>

#include "app/error.h"
#include "tools/facewire/rig/character.h"
#include "tools/facewire/rig/gltf_json.h"
#include "tools/facewire/rig/import_plan.h"
#include "tools/facewire/rig/import_text.h"
#include "tools/facewire/rig/rig_names.h"

namespace facewire::tools::rig {

ImportedRig ImportRig(std::string_view bytes, const std::string& source, double cm_per_unit) {
  const Character character = ReadCharacter(ParseGltf(bytes, source), source);
  const std::filesystem::path file(source);
  const ImportPlan plan = PlanImport(character, {file.stem().string(), cm_per_unit});
  if (IsEmpty(plan))
    throw app::BadInput(source +
                        ": nothing of a face was found in it: no blend shape and no bone has a "
                        "name that facewire knows (tools/facewire/rig/README.md lists them)");
  constexpr float kFarthestCm = 1000;  // app/rig_file.cc's
  for (const PlannedBone& bone : plan.bones)
    if (!IsWithin(bone.rest_cm, kFarthestCm))
      throw app::BadInput(source + ": " + Shown(bone.original) +
                          " is more than 10 m from the origin; another --unit, or the character "
                          "moved to the origin, would be right");
  return {RigText(plan, character, file.filename().string()), SummaryText(plan, character)};
}

}  // namespace facewire::tools::rig
