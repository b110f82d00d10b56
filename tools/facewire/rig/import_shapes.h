#ifndef FACEWIRE_TOOLS_FACEWIRE_RIG_IMPORT_SHAPES_H_
#define FACEWIRE_TOOLS_FACEWIRE_RIG_IMPORT_SHAPES_H_

#include <cstddef>

#include "tools/facewire/rig/character.h"
#include "tools/facewire/rig/import_plan.h"
#include "tools/facewire/rig/rig_names.h"

namespace facewire::tools::rig {

// Finds what drives the character's shapes: fills the plan's parameters (at most `room`), lacking,
// unknown_shapes and notes. A signal is given to one shape, or to the shapes of one expression: the
// surest match has it.
void PlanShapes(const Character& character, std::size_t room, RigNames& names, ImportPlan& plan);

}  // namespace facewire::tools::rig

#endif  // FACEWIRE_TOOLS_FACEWIRE_RIG_IMPORT_SHAPES_H_
