#ifndef FACEWIRE_TOOLS_FACEWIRE_SESSION_FRAME_H_
#define FACEWIRE_TOOLS_FACEWIRE_SESSION_FRAME_H_

#include <cstdint>
#include <vector>

#include "core/base/geometry.h"

namespace facewire::tools {

// Points of one frame of a session in the head frame, cm; NaN where a marker was not seen. Frames
// without a face, or without a marker that was seen, have none.
struct SessionFrame {
  std::uint64_t frame = 0;
  std::int64_t t_us = 0;  // since the recording's first frame
  std::vector<Point3> points_cm;
};

}  // namespace facewire::tools

#endif  // FACEWIRE_TOOLS_FACEWIRE_SESSION_FRAME_H_
