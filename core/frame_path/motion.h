#ifndef FACEWIRE_CORE_FRAME_PATH_MOTION_H_
#define FACEWIRE_CORE_FRAME_PATH_MOTION_H_

#include <cstdint>

#include "core/base/result.h"
#include "core/limit/limiter.h"
#include "core/rig/rig.h"
#include "core/rig_pose.h"
#include "core/service_state.h"
#include "core/state/state_machine.h"

namespace facewire {

// What leaves for the host in one tick.
struct MotionOutput {
  RigPose pose;  // within every limit; stamped as the wish of this tick
  ServiceState state = ServiceState::kStarting;
  bool torque = true;
  bool finished = false;  // as state::Outputs
};

// The second half of a tick: decides by the state machine, carries the decision out as a blend of
// poses, and limits the result.
class Motion {
 public:
  // The rig must have passed its checks. The motion begins at its neutral pose, or, when a motion
  // was going on, with every channel of the same name and kind where it is, ramping to neutral.
  // `rig` is copied from, not kept. kOutOfRange: as Limiter::Configure and StateMachine::Configure;
  // then the motion goes on as it was.
  Result<> Configure(const Rig& rig, const state::StateConfig& states, Time now) noexcept;

  // One tick. `wish` gives the stamps (seq, captured) always, and the values when in.sight is
  // kFace.
  MotionOutput Update(const state::Inputs& in, const RigPose& wish) noexcept;

  ServiceState state() const noexcept { return machine_.state(); }

 private:
  void Take(const RigPose& wish) noexcept;
  const RigPose& Aim(const state::Outputs& decision) noexcept;

  state::StateMachine machine_;
  limit::Limiter limiter_;
  Rig rig_;
  RigPose neutral_;
  RigPose latest_;  // of the face
  RigPose from_;    // where the present blend began
  RigPose aimed_;   // the last target of the limiter
  RigPose sent_;
};

}  // namespace facewire

#endif  // FACEWIRE_CORE_FRAME_PATH_MOTION_H_
