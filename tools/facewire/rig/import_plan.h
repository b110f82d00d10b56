#ifndef FACEWIRE_TOOLS_FACEWIRE_RIG_IMPORT_PLAN_H_
#define FACEWIRE_TOOLS_FACEWIRE_RIG_IMPORT_PLAN_H_

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "core/base/geometry.h"
#include "tools/facewire/rig/bone_names.h"
#include "tools/facewire/rig/character.h"

namespace facewire::tools::rig {

using Drives = std::vector<std::pair<std::string, double>>;  // signal, gain

// An axis of a bone, or what the rig file says of it.
struct PlannedAxis {
  std::string name;  // "pitch"
  double min = 0, max = 0;
  double max_speed = 0, max_acceleration = 0;
  bool hard = false;  // no knee: a lid that closes must close fully
  Drives drives;      // empty: follows the bone's landmark
};

struct PlannedBone {
  std::string name;      // in the rig
  std::string original;  // in the file
  std::string why;       // which rule found it
  Point3 rest_cm{};
  BoneRole role;
  std::vector<PlannedAxis> axes;
  // What moves the same part already ("the shape jawOpen"): the axes are left to the user.
  std::string done_by;
};

struct PlannedParameter {
  std::string name;      // in the rig
  std::string original;  // in the file
  std::string why;
  Drives drives;
  std::size_t order = 0;  // where its first signal is in ArkitShapes()
};

// A rig that was found in a character, and what was not.
struct ImportPlan {
  std::string name;
  double cm_per_unit = 100;
  bool turned = false;  // the file faces -z and was turned half round
  std::vector<PlannedBone> bones;
  std::vector<PlannedParameter> parameters;
  std::vector<std::string> lacking;  // ARKit's shapes that nothing here shows
  std::vector<std::string> notes;    // what was found and not used, each with the reason
  std::vector<std::string> unknown_shapes;
  std::vector<std::string> other_bones;
};

struct ImportSettings {
  std::string fallback_name;  // when the character has none
  double cm_per_unit = 0;     // 0: judged by the distance between the eyes, or the size
};

ImportPlan PlanImport(const Character& character, const ImportSettings& settings);

}  // namespace facewire::tools::rig

#endif  // FACEWIRE_TOOLS_FACEWIRE_RIG_IMPORT_PLAN_H_
