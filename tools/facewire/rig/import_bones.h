#ifndef FACEWIRE_TOOLS_FACEWIRE_RIG_IMPORT_BONES_H_
#define FACEWIRE_TOOLS_FACEWIRE_RIG_IMPORT_BONES_H_

#include "tools/facewire/rig/character.h"
#include "tools/facewire/rig/import_plan.h"
#include "tools/facewire/rig/rig_names.h"

namespace facewire::tools::rig {

// Finds the bones of the face: by VRM's humanoid, by name, and, with both eyes found, those below
// the head by where they lie on the canonical face. Fills the plan's bones, other_bones and
// turned, and cm_per_unit unless that is given (0). After PlanShapes: what shapes do, bones do not
// do again.
void PlanBones(const Character& character, RigNames& names, ImportPlan& plan);

// The axes of a bone, before anything is known about shapes. `scale`: size of the character's face,
// a person's is 1. `turns`: a lid that sits at the eye's centre and turns around it. `share`: the
// part of the head's rotation that is this bone's. `place`: the landmark's name, or the nearest one
// that has a name.
std::vector<PlannedAxis> AxesOf(const BoneRole& role, std::string_view place, double scale,
                                bool turns, double share);

}  // namespace facewire::tools::rig

#endif  // FACEWIRE_TOOLS_FACEWIRE_RIG_IMPORT_BONES_H_
