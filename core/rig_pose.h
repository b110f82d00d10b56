#ifndef FACEWIRE_CORE_RIG_POSE_H_
#define FACEWIRE_CORE_RIG_POSE_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "core/base/capacity.h"
#include "core/base/time.h"

namespace facewire {

// A value for every channel of a rig, in the order of Rig::channels (core/rig/rig.h) and in the
// unit of each channel's kind.
struct RigPose {
  std::uint64_t seq = 0;  // of the frame it answers
  Time captured{};        // of that frame
  std::size_t count = 0;
  std::array<float, kMaxChannels> values{};
};
static_assert(std::is_trivially_copyable_v<RigPose>);

}  // namespace facewire

#endif  // FACEWIRE_CORE_RIG_POSE_H_
