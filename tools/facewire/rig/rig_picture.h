#ifndef FACEWIRE_TOOLS_FACEWIRE_RIG_RIG_PICTURE_H_
#define FACEWIRE_TOOLS_FACEWIRE_RIG_RIG_PICTURE_H_

#include <opencv2/core.hpp>

#include "core/rig/rig.h"

namespace facewire::tools::rig {

// Draws a rig, kSheetWidthPx wide: its bones from the front and from the character's left over the
// landmarks of a person's face, with a line from each to the landmark that it follows; below them
// every channel with its range, its neutral and what drives it, by the part of the face. The result
// is 8-bit BGR.
cv::Mat DrawRig(const Rig& rig);

}  // namespace facewire::tools::rig

#endif  // FACEWIRE_TOOLS_FACEWIRE_RIG_RIG_PICTURE_H_
