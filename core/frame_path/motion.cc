#include "core/frame_path/motion.h"

#include <algorithm>
#include <cmath>

namespace facewire {
namespace {

RigPose Mix(const RigPose& from, const RigPose& to, float blend) noexcept {
  if (blend >= 1) return to;
  RigPose mixed = to;
  for (std::size_t i = 0; i < to.count; ++i) {
    mixed.values[i] = from.values[i] + blend * (to.values[i] - from.values[i]);
  }
  return mixed;
}

// `pose` of the old rig as the new one has it: channels are the same when name and kind are.
RigPose Carried(const Rig& old, const RigPose& pose, const Rig& fresh) noexcept {
  RigPose carried = fresh.NeutralPose();
  for (std::size_t i = 0; i < fresh.channels.size(); ++i) {
    const Channel& channel = fresh.channels[i];
    const auto at = old.FindChannel(channel.name.view());
    if (!at || old.channels[*at].kind != channel.kind) continue;
    carried.values[i] = std::clamp(pose.values[*at], channel.min, channel.max);
  }
  return carried;
}

}  // namespace

Result<> Motion::Configure(const Rig& rig, const state::StateConfig& states, Time now) noexcept {
  limit::Limiter limiter;
  if (const Result<> ok = limiter.Configure(rig); !ok) return ok.error();
  if (const Result<> ok = machine_.Configure(states); !ok) return ok.error();
  const RigPose start = Carried(rig_, sent_, rig);
  limiter.Reset(start);
  limiter_ = limiter;
  rig_ = rig;
  neutral_ = rig.NeutralPose();
  latest_ = from_ = aimed_ = sent_ = start;
  machine_.Restart(now);
  return {};
}

MotionOutput Motion::Update(const state::Inputs& in, const RigPose& wish) noexcept {
  if (in.sight == state::Sight::kFace) Take(wish);
  const state::Outputs decision = machine_.Update(in);
  if (decision.state == ServiceState::kStopped) {
    // Frozen where it is, at rest: not even a braking distance.
    if (decision.blend_begins) limiter_.Reset(sent_);
    aimed_ = sent_;
  } else {
    if (decision.blend_begins) from_ = aimed_;
    aimed_ = Mix(from_, Aim(decision), decision.blend);
    sent_ = limiter_.Update(aimed_, in.now);
  }
  sent_.seq = wish.seq;
  sent_.captured = wish.captured;
  return {sent_, decision.state, decision.torque, decision.finished};
}

// Within the limits before it is blended: a blend of huge numbers is none. A value that is missing
// or not a number stays as it was sent, because a blend would never be rid of it.
void Motion::Take(const RigPose& wish) noexcept {
  for (std::size_t i = 0; i < latest_.count; ++i) {
    const bool usable = i < wish.count && !std::isnan(wish.values[i]);
    const Channel& channel = rig_.channels[i];
    latest_.values[i] =
        usable ? std::clamp(wish.values[i], channel.min, channel.max) : sent_.values[i];
  }
}

const RigPose& Motion::Aim(const state::Outputs& decision) noexcept {
  switch (decision.target) {
    case state::Target::kPose:
      return latest_;
    case state::Target::kHeld:
      return from_;
    case state::Target::kNeutral:
      break;
  }
  return neutral_;
}

}  // namespace facewire
