#ifndef FACEWIRE_CORE_LIMIT_LIMITER_H_
#define FACEWIRE_CORE_LIMIT_LIMITER_H_

#include <array>
#include <chrono>
#include <cstddef>
#include <optional>

#include "core/base/capacity.h"
#include "core/base/result.h"
#include "core/base/time.h"
#include "core/limit/motion.h"
#include "core/rig/rig.h"
#include "core/rig_pose.h"

namespace facewire::limit {

// After a longer silence the host has come to rest at the last values it got: the motion goes on
// from there at speed 0, and moves no further than it may in this time.
inline constexpr Duration kMaxStep = std::chrono::milliseconds(200);

// The last stage before the wire: no value leaves it outside its channel's limits, whatever comes
// in. Every channel moves on the fastest way to its target that keeps its speed and acceleration
// (core/limit/motion.h), and brakes in time: the hard limits need no exception from the soft ones.
class Limiter {
 public:
  // Starts at the rig's neutral pose. The rig is copied from, not kept.
  // kOutOfRange: min <= neutral <= max does not hold, a number is not finite, or a maximum is
  // negative, for some channel; nothing is changed then.
  Result<> Configure(const Rig& rig) noexcept;
  // The motion continues from `pose` (clamped), at rest, and stays there until a target comes. A
  // value that is NaN or missing (pose.count too small) means neutral.
  void Reset(const RigPose& pose) noexcept;
  // A step towards `target` that ends at `now`. seq and captured pass through; count is the rig's.
  // A target that is NaN or missing leaves the channel on the way to its last one; infinities mean
  // the limits. Channels without speed and acceleration limits are at their target at once. For the
  // others:
  //   the first call after Configure or Reset has no step to make: it only starts the time;
  //   no time passed, or it went back by up to kMaxStep: nothing moves;
  //   it went back further (another clock): as after a long silence, but nothing moves in this
  //   call.
  RigPose Update(const RigPose& target, Time now) noexcept;

 private:
  struct Channel {
    float min = 0;
    float max = 0;
    float neutral = 0;
    MotionLimits limits{};
    Motion motion{};
    float target = 0;  // clamped
  };
  // How long the step that ends at `now` is; stops all channels where the time leaps.
  double StepSeconds(Time now) noexcept;

  std::array<Channel, kMaxChannels> channels_{};
  std::size_t count_ = 0;
  std::optional<Time> last_;
};

}  // namespace facewire::limit

#endif  // FACEWIRE_CORE_LIMIT_LIMITER_H_
