#ifndef FACEWIRE_TOOLS_FACEWIRE_RIG_RIG_CHECK_H_
#define FACEWIRE_TOOLS_FACEWIRE_RIG_RIG_CHECK_H_

#include <span>
#include <string>
#include <vector>

#include "core/rig/rig.h"
#include "core/servo/servo_rig.h"

namespace facewire::tools::rig {

struct Remark {
  bool lacks = false;  // the character will not read as a face without it; else a hint
  std::string text;    // one line
};

// What a rig that loads still lacks for a face to read, and what its author may not have meant:
// what nobody sees of a performer, channels that never move or never get far, motion without a
// limit, servos that lose a part of it. `signals`: those of the profile; a drive by another one
// does nothing.
std::vector<Remark> CheckRig(const Rig& rig, const servo::ServoRig& servos,
                             std::span<const std::string> signals);

// What drives can make of a channel: its value at the least and the greatest sum, before limits.
struct Reach {
  double low = 0, high = 0;
};
// Profile signals go from 0 to 1, the head turns 60 degrees and moves 10 cm either way.
Reach ReachOf(const Channel& channel);

}  // namespace facewire::tools::rig

#endif  // FACEWIRE_TOOLS_FACEWIRE_RIG_RIG_CHECK_H_
