#ifndef FACEWIRE_CORE_LIMIT_LIMITER_H_
#define FACEWIRE_CORE_LIMIT_LIMITER_H_

#include <span>

#include "core/base/result.h"
#include "core/base/time.h"
#include "core/rig/rig.h"
#include "core/rig_pose.h"

namespace facewire::limit {

// The last stage before the wire: no value leaves it outside its channel's limits, whatever comes in.
class Limiter {
 public:
  // Starts at the rig's neutral pose. The rig is copied from, not kept.
  // kOutOfRange: min <= neutral <= max does not hold or a number is not finite, for some channel.
  Result<> Configure(const Rig& rig) noexcept;
  // The motion continues from `pose` (clamped), at rest.
  void Reset(const RigPose& pose) noexcept;
  // A step towards `target` that ends at `now`. seq and captured pass through.
  RigPose Update(const RigPose& target, Time now) noexcept;
};

}  // namespace facewire::limit

#endif  // FACEWIRE_CORE_LIMIT_LIMITER_H_
