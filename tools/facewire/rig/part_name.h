#ifndef FACEWIRE_TOOLS_FACEWIRE_RIG_PART_NAME_H_
#define FACEWIRE_TOOLS_FACEWIRE_RIG_PART_NAME_H_

#include <string>
#include <string_view>
#include <vector>

namespace facewire::tools::rig {

enum class Side { kNone, kLeft, kRight };

// "l", "left", "r" or "right"; kNone for any other word.
Side SideNamed(std::string_view word);

// A name as people's spelling leaves it: "mixamorig:LeftEye", "eye.L", "J_Adj_L_FaceEye" and
// "eyeBlinkLeft" come apart into small words and a side.
struct PartName {
  std::vector<std::string> words;  // without the side: {"eye", "blink"}
  Side side = Side::kNone;

  std::string Joined() const;  // "eyeblink"
  bool Has(std::string_view word) const;
};

// Namespaces (before the last ':' or '|', or a '.' that no side follows) are dropped. A side is a
// word of its own, l, r, left or right, or ends a name without capitals.
PartName TakeApart(std::string_view name);

}  // namespace facewire::tools::rig

#endif  // FACEWIRE_TOOLS_FACEWIRE_RIG_PART_NAME_H_
