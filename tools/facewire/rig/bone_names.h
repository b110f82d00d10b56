#ifndef FACEWIRE_TOOLS_FACEWIRE_RIG_BONE_NAMES_H_
#define FACEWIRE_TOOLS_FACEWIRE_RIG_BONE_NAMES_H_

#include <optional>
#include <string>
#include <string_view>

#include "tools/facewire/rig/part_name.h"

namespace facewire::tools::rig {

// What a bone is for. A jaw's bone is its hinge and no eye's bone is its iris, so neither follows a
// landmark.
enum class BoneKind { kHead, kNeck, kJaw, kEye, kUpperLid, kLowerLid, kSkin };

struct BoneRole {
  BoneKind kind = BoneKind::kSkin;
  Side side = Side::kNone;
  std::string landmark;  // of app/rig_file.h; empty: follows none

  friend bool operator==(const BoneRole&, const BoneRole&) = default;
};

// By the bone's own name ("mixamorig:Head", "J_Adj_L_FaceEye", "lip_corner.R"); nullopt when it
// does not say.
std::optional<BoneRole> MatchBone(std::string_view name);

// Whether the name says that it is no part of the face's skin: an end, a handle, hair.
bool IsHelper(std::string_view name);

// By VRM's name of a humanoid's bone; nullopt for those outside the face.
std::optional<BoneRole> MatchHumanoid(std::string_view name);

}  // namespace facewire::tools::rig

#endif  // FACEWIRE_TOOLS_FACEWIRE_RIG_BONE_NAMES_H_
