#include "core/state/state_machine.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace facewire {

const char* Name(ServiceState state) noexcept {
  switch (state) {
    case ServiceState::kStarting:
      return "starting";
    case ServiceState::kSearching:
      return "searching";
    case ServiceState::kTracking:
      return "tracking";
    case ServiceState::kHolding:
      return "holding";
    case ServiceState::kEasing:
      return "easing";
    case ServiceState::kResting:
      return "resting";
    case ServiceState::kStopped:
      return "stopped";
    case ServiceState::kFault:
      return "fault";
  }
  return "unknown";
}

namespace state {
namespace {

// Ticks come at 20 Hz or faster, even without a camera, unless a picture takes longer than that.
constexpr Duration kLongestTick = std::chrono::milliseconds(500);
// A picture may be so late before it counts as missing: cameras that see little light slow down.
constexpr Duration kLatePicture = std::chrono::milliseconds(200);

// Smoothstep: starts and ends without a jump in speed.
float Smooth(Duration elapsed, Duration whole) noexcept {
  if (elapsed >= whole) return 1;
  const float t = Seconds(elapsed) / Seconds(whole);
  return t * t * (3 - 2 * t);
}

Target TargetOf(ServiceState state) noexcept {
  switch (state) {
    case ServiceState::kTracking:
      return Target::kPose;
    case ServiceState::kHolding:
    case ServiceState::kStopped:
      return Target::kHeld;
    default:
      return Target::kNeutral;
  }
}

}  // namespace

Result<> StateMachine::Configure(const StateConfig& config) noexcept {
  for (const Duration d : {config.start_ramp, config.acquire, config.hold, config.ease,
                           config.rest_after, config.camera_timeout}) {
    if (d < Duration::zero()) return Errc::kOutOfRange;
  }
  config_ = config;
  return {};
}

void StateMachine::Restart(Time now) noexcept {
  const bool first = !started_;
  now_ = started_ ? std::max(now_, now) : now;
  started_ = true;
  last_picture_ = now_;
  if (state_ != ServiceState::kStopped) Enter(ServiceState::kStarting);
  // What is sent first is neutral: there is nothing to ramp from, and a head that is switched on
  // should soon be alive.
  if (first) blend_time_ = Duration::zero();
}

bool StateMachine::SettledAtNeutral() const noexcept {
  return TargetOf(state_) == Target::kNeutral && neutral_frames_ >= config_.neutral_frames;
}

Outputs StateMachine::Update(const Inputs& in) noexcept {
  if (!started_) Restart(in.now);
  const Duration gap = in.now - now_;
  now_ = std::max(now_, in.now);
  if (in.quit && !quitting_) neutral_frames_ = 0;  // those sent long ago do not count
  quitting_ = quitting_ || in.quit;
  if (in.sight != Sight::kSilent) last_picture_ = now_;

  const ServiceState next = Next(in);
  // A face after a long gap between ticks (the process was suspended) is found anew, without a
  // jump. Where one long gap follows the other the computer is slow, and the face was not lost.
  const bool late = gap > kLongestTick;
  const bool woke = late && !late_;
  late_ = late;
  if (next != state_ || (next == ServiceState::kTracking && woke)) Enter(next);
  if (next == ServiceState::kTracking && in.sight == Sight::kFace) last_face_ = now_;

  Outputs out;
  out.state = state_;
  out.target = TargetOf(state_);
  out.blend_begins = std::exchange(blend_begins_, false);
  out.blend = Smooth(now_ - blend_began_, blend_time_);
  out.torque = state_ != ServiceState::kStopped && state_ != ServiceState::kResting &&
               !(state_ == ServiceState::kFault && Elapsed(neutral_since_, config_.rest_after));
  if (out.target == Target::kNeutral && out.blend >= 1) {
    if (neutral_frames_ < std::numeric_limits<std::uint32_t>::max()) ++neutral_frames_;
  } else {
    neutral_frames_ = 0;
  }
  // A stopped rig must not move, not even to neutral, so there is nothing to wait for.
  out.finished = quitting_ && (state_ == ServiceState::kStopped || SettledAtNeutral());
  return out;
}

// The whole transition table, most urgent first.
ServiceState StateMachine::Next(const Inputs& in) noexcept {
  if (in.stop) return ServiceState::kStopped;
  switch (state_) {
    case ServiceState::kStopped:
      return in.release && !quitting_ ? ServiceState::kStarting : ServiceState::kStopped;
    case ServiceState::kStarting:
    case ServiceState::kSearching:
    case ServiceState::kTracking:
    case ServiceState::kHolding:
    case ServiceState::kEasing:
    case ServiceState::kResting:
    case ServiceState::kFault:
      break;
    default:
      return ServiceState::kStopped;  // memory was damaged: the safe state
  }
  if (quitting_) {  // limp servos stay limp: torque without need could jerk
    return state_ == ServiceState::kResting ? ServiceState::kResting : ServiceState::kEasing;
  }
  if (in.line_gone) return ServiceState::kFault;
  if (state_ == ServiceState::kStarting) {
    return SettledAtNeutral() ? ServiceState::kSearching : ServiceState::kStarting;
  }
  if (state_ == ServiceState::kFault) {
    // What the host last received is unknown: start over, from neutral.
    return in.sight == Sight::kSilent ? ServiceState::kFault : ServiceState::kStarting;
  }
  if (in.rest && (state_ == ServiceState::kTracking || state_ == ServiceState::kHolding)) {
    return ServiceState::kEasing;
  }
  if (in.sight == Sight::kFace && !in.rest) return ServiceState::kTracking;
  return NextUnseen(in);
}

ServiceState StateMachine::NextUnseen(const Inputs& in) const noexcept {
  const bool blind = in.sight == Sight::kSilent && Elapsed(last_picture_, config_.camera_timeout);
  switch (state_) {
    case ServiceState::kTracking:
      if (in.sight == Sight::kSilent && !Elapsed(last_picture_, kLatePicture)) return state_;
      return ServiceState::kHolding;
    case ServiceState::kHolding:
      return Elapsed(last_face_, config_.hold) ? ServiceState::kEasing : ServiceState::kHolding;
    case ServiceState::kEasing:
      if (!Elapsed(blend_began_, blend_time_)) return ServiceState::kEasing;
      return blind ? ServiceState::kFault : ServiceState::kSearching;
    case ServiceState::kSearching:
      if (blind) return ServiceState::kFault;
      return Elapsed(neutral_since_, config_.rest_after) ? ServiceState::kResting
                                                         : ServiceState::kSearching;
    default:
      return blind ? ServiceState::kFault : state_;
  }
}

void StateMachine::Enter(ServiceState next) noexcept {
  const bool was_neutral = TargetOf(state_) == Target::kNeutral;
  const bool is_neutral = TargetOf(next) == Target::kNeutral;
  const bool restarts = next == ServiceState::kStarting;
  state_ = next;
  if (is_neutral && (!was_neutral || restarts)) neutral_since_ = now_;
  if (restarts) neutral_frames_ = 0;
  // From neutral to neutral (easing -> searching -> resting) nothing moves: the blend goes on.
  if (was_neutral && is_neutral && !restarts) return;
  blend_begins_ = true;
  blend_began_ = now_;
  switch (next) {
    case ServiceState::kTracking:
      // As long as the loss was: a single lost frame must not blur what comes next.
      blend_time_ = std::min(config_.acquire, now_ - last_face_);
      break;
    case ServiceState::kStarting:
      blend_time_ = config_.start_ramp;
      break;
    case ServiceState::kEasing:
    case ServiceState::kFault:
      blend_time_ = config_.ease;
      break;
    default:
      blend_time_ = Duration::zero();
  }
}

}  // namespace state
}  // namespace facewire
