#ifndef FACEWIRE_TOOLS_FACEWIRE_RIG_IMPORT_TEXT_H_
#define FACEWIRE_TOOLS_FACEWIRE_RIG_IMPORT_TEXT_H_

#include <string>

#include "tools/facewire/rig/character.h"
#include "tools/facewire/rig/import_plan.h"

namespace facewire::tools::rig {

// Whether there is anything for a rig to move.
bool IsEmpty(const ImportPlan& plan);

// The rig.toml of a plan, with comments that say where everything comes from. `source`: the
// character's file.
std::string RigText(const ImportPlan& plan, const Character& character, const std::string& source);

// The same findings in a few lines, for a terminal.
std::string SummaryText(const ImportPlan& plan, const Character& character);

}  // namespace facewire::tools::rig

#endif  // FACEWIRE_TOOLS_FACEWIRE_RIG_IMPORT_TEXT_H_
