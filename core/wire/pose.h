#ifndef FACEWIRE_CORE_WIRE_POSE_H_
#define FACEWIRE_CORE_WIRE_POSE_H_

#include <cstdint>

#include "core/rig/rig.h"
#include "core/rig_pose.h"
#include "core/service_state.h"
#include "core/wire/message.h"

namespace facewire::wire {

// A channel's value as the wire carries it: the nearest of 65536 steps from min (0) to max (65535).
// Beyond the range: its end. NaN: the step of neutral. A range of no width (or not a number): 0.
std::uint16_t Quantise(float value, float neutral, float min, float max) noexcept;

// min + step / 65535 * (max - min), never outside min..max.
float Dequantise(std::uint16_t step, float min, float max) noexcept;

// The message for one frame. Channels that `pose` has no value for are neutral, and surplus values
// are not sent. `rig_id` is RigId(rig), computed once; `now` is the time of encoding, from which
// age_us comes (0 when `now` lies before the capture; saturates at 2^32 - 1).
Pose MakePose(const Rig& rig, std::uint32_t rig_id, const RigPose& pose, ServiceState state,
              Time now) noexcept;

// The host's side: the values in the channels' units, for a rig that a RigCollector gathered.
// Values that the message does not have are neutral.
RigPose ValuesOf(const Pose& pose, const Rig& rig) noexcept;

}  // namespace facewire::wire

#endif  // FACEWIRE_CORE_WIRE_POSE_H_
