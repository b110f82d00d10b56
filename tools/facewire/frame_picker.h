#ifndef FACEWIRE_TOOLS_FACEWIRE_FRAME_PICKER_H_
#define FACEWIRE_TOOLS_FACEWIRE_FRAME_PICKER_H_

#include <cstddef>
#include <optional>
#include <vector>

#include "tools/facewire/session_frame.h"

namespace facewire::tools {

struct PickRules {
  std::size_t most = 32;  // frames, with the neutral
  // Enough is picked when no still moment is further from what is explained than this part of the
  // greatest motion, 0..1. 0: only `most` ends the search.
  double tolerance = 0.12;
  std::optional<std::size_t> neutral;  // index of the frame that is the face at rest; else found
};

struct PickedFrame {
  std::size_t index = 0;  // of the frame
  // Part of the recording's motion that this frame and those before it explain, 0..1: one minus the
  // squared distances that are left, over the squared distances from the neutral; all frames.
  double explained = 0;
  // Markers by how far they are from what those before explain, furthest first.
  std::vector<std::size_t> moved;
};

struct PickedFrames {
  std::vector<PickedFrame> frames;  // the neutral, then each next one by how much it was missing
  std::size_t furthest = 0;         // index of the frame that is explained worst
  double furthest_cm = 0;           // root mean square over its markers
};

// Suggests the frames of a recording that show its most different expressions, as few as needed.
//
// The neutral is the most typical still frame: of those that move less than the median, the one
// with the least mean distance to all frames. Then, again and again, the still moment that is
// furthest from what the picked frames explain is picked too (farthest-point selection, T. Gonzalez
// 1985). What frames explain are their blends, as in a rig of blend shapes: the neutral plus their
// motions, each weighted 0 to 1. So half a smile beside a whole one adds nothing, and a distance to
// the nearest frame alone would pick both. Still moments are those with the least speed within a
// tenth of a second: apexes and held poses, no blurs and no single bad frames.
//
// Only frames in which every marker was seen take part; needs one at least, and a neutral among
// them. Distances are root mean squares over markers.
PickedFrames PickFrames(const std::vector<SessionFrame>& frames, const PickRules& rules);

// Every marker was seen.
bool IsComplete(const SessionFrame& frame);

}  // namespace facewire::tools

#endif  // FACEWIRE_TOOLS_FACEWIRE_FRAME_PICKER_H_
