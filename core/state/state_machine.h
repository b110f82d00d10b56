#ifndef FACEWIRE_CORE_STATE_STATE_MACHINE_H_
#define FACEWIRE_CORE_STATE_STATE_MACHINE_H_

#include <chrono>
#include <cstdint>

#include "core/base/result.h"
#include "core/base/time.h"
#include "core/service_state.h"

namespace facewire::state {

// Times of the failsafe contract: hold, ease to neutral, torque off. The same for every host.
struct StateConfig {
  // From where a stop or a fault left off to neutral. (At power-on the first pose is neutral.)
  Duration start_ramp = std::chrono::milliseconds(1500);
  Duration acquire = std::chrono::milliseconds(300);  // fade-in of a face that was found (again)
  Duration hold = std::chrono::milliseconds(400);     // the last pose is kept when a face is lost
  Duration ease = std::chrono::milliseconds(1500);    // from there to neutral
  Duration rest_after = std::chrono::seconds(60);     // neutral for so long: torque off
  Duration camera_timeout = std::chrono::seconds(2);  // silent for so long: a fault
  std::uint32_t neutral_frames = 10;  // at least so many neutral frames at start and at the end
};

// What the camera and the stages made of this tick.
enum class Sight : std::uint8_t {
  kFace,      // a pose to follow
  kNoFace,    // a picture without a face
  kRejected,  // a face that cannot be right (jump, collapse); treated as kNoFace, counted apart
  kSilent,    // no new picture: the camera is slow, silent or gone
};

struct Inputs {
  Time now{};
  Sight sight = Sight::kNoFace;
  bool stop = false;     // emergency stop: a command, or a line that is asserted at this moment
  bool release = false;  // leave the emergency stop; ignored while `stop` is true
  bool rest = false;  // somebody wants neutral, whatever the camera sees, for as long as it is set
  bool quit = false;  // the process was asked to end; latched
  bool line_gone = false;  // nobody can receive: the host's line is closed
};

enum class Target : std::uint8_t {
  kPose,     // the latest pose of the face
  kHeld,     // what was aimed at last
  kNeutral,  // the rig's neutral pose
};

// What to send: blend * target + (1 - blend) * the pose aimed at when the blend began.
struct Outputs {
  ServiceState state = ServiceState::kStarting;
  Target target = Target::kNeutral;
  bool blend_begins = false;  // the pose aimed at last is the start of the blend
  float blend = 1;            // 0..1, smooth at both ends
  bool torque = true;         // false: servos may go limp
  bool finished = false;      // after `quit`: neutral was reached and sent often enough
};

// Decides, and only that: no pose, no clock, no I/O. Every change of target is a blend from what
// was aimed at, so nothing ever jumps; the limiter behind it bounds speeds besides.
class StateMachine {
 public:
  // kOutOfRange: a negative time.
  Result<> Configure(const StateConfig& config) noexcept;
  // Back to kStarting. An emergency stop survives it: only a release ends one.
  void Restart(Time now) noexcept;
  // One tick. A `now` before the last one counts as the last one.
  Outputs Update(const Inputs& in) noexcept;

  ServiceState state() const noexcept { return state_; }

 private:
  ServiceState Next(const Inputs& in) noexcept;
  ServiceState NextUnseen(const Inputs& in) const noexcept;
  bool Elapsed(Time since, Duration wanted) const noexcept { return now_ - since >= wanted; }
  bool SettledAtNeutral() const noexcept;
  void Enter(ServiceState next) noexcept;

  StateConfig config_;
  ServiceState state_ = ServiceState::kStarting;
  bool started_ = false;  // a first tick has set the times below
  bool quitting_ = false;
  Time now_{};
  bool late_ = false;  // the last gap between ticks was a long one
  bool blend_begins_ = false;
  Time blend_began_{};
  Duration blend_time_{};
  Time last_face_{};
  Time last_picture_{};
  Time neutral_since_{};              // the target is neutral
  std::uint32_t neutral_frames_ = 0;  // ticks that sent neutral at full blend, in a row
};

}  // namespace facewire::state

#endif  // FACEWIRE_CORE_STATE_STATE_MACHINE_H_
