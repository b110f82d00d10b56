#ifndef FACEWIRE_TOOLS_FACEWIRE_MARKER_LAYOUT_H_
#define FACEWIRE_TOOLS_FACEWIRE_MARKER_LAYOUT_H_

#include <cstdint>
#include <string>
#include <vector>

#include "core/retarget/expression_mapping.h"
#include "core/rig/rig.h"

namespace facewire::tools {

// Which markers of a take are read, and where they go: marker names[i] to
// FacePose::points_cm[points[i]].
struct MarkerLayout {
  std::vector<std::string> names;
  std::vector<std::int16_t> points;
  std::string needed_by;  // for complaints: "the profile"
};

// Those of the profile (may be null) and of the rig's bones. Bone::landmark becomes the place of
// the bone's marker. A bone with a landmark follows the marker "lm33" of that landmark: of the
// profile's if it reads that, and of the take's if there is no profile; else it rests, with -1.
MarkerLayout LayOutMarkers(const retarget::ExpressionMapping* profile, Rig& rig);

}  // namespace facewire::tools

#endif  // FACEWIRE_TOOLS_FACEWIRE_MARKER_LAYOUT_H_
