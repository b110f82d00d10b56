#ifndef FACEWIRE_TOOLS_SHEET_PICK_H_
#define FACEWIRE_TOOLS_SHEET_PICK_H_

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "core/rig/rig.h"
#include "core/rig_pose.h"

namespace facewire::tools {

struct Pick {
  std::size_t index = 0;  // into the poses
  std::string caption;    // "eyes shut"
};

// The most telling poses of a recording, at most `count`, in the order of the recording: the
// calmest one, and the extremes of what the character does (eyes shut, mouth open, head turned
// ...), at least half a second from each other by their capture times. Movements that hardly occur
// are left out.
std::vector<Pick> PickMoments(const Rig& rig, std::span<const RigPose> poses, std::size_t count);

}  // namespace facewire::tools

#endif  // FACEWIRE_TOOLS_SHEET_PICK_H_
