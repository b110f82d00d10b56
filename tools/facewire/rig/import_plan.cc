#include "tools/facewire/rig/import_plan.h"

#include "core/base/capacity.h"
#include "tools/facewire/rig/import_bones.h"
#include "tools/facewire/rig/import_shapes.h"
#include "tools/facewire/rig/rig_names.h"

namespace facewire::tools::rig {
namespace {

// So many channels are kept for bones; a face has no more than 52 shapes, and what VRM's
// expressions move.
constexpr std::size_t kKeptForBones = 80;

}  // namespace

ImportPlan PlanImport(const Character& character, const ImportSettings& settings) {
  ImportPlan plan;
  plan.name = RigNames().Take(character.name.empty() ? settings.fallback_name : character.name,
                              "character", kMaxNameLength);
  plan.cm_per_unit = settings.cm_per_unit;
  RigNames parameters, bones;
  PlanShapes(character, kMaxChannels - kKeptForBones, parameters, plan);
  PlanBones(character, bones, plan);
  return plan;
}

}  // namespace facewire::tools::rig
