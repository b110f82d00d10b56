#ifndef FACEWIRE_CORE_SERVO_AIM_H_
#define FACEWIRE_CORE_SERVO_AIM_H_

#include <chrono>
#include <cstdint>
#include <optional>

#include "core/base/time.h"
#include "core/servo/follower.h"
#include "core/servo/servo_rig.h"

namespace facewire::servo {

// What a servo is doing. Torque is on from kFollowing to kResting, and off besides.
enum class Activity : std::uint8_t {
  kWaiting,    // no wish yet, or its position has not been read yet
  kFollowing,  // the performer
  kManual,     // a hand
  kHolding,    // the contract, one after the other
  kEasing,
  kResting,  // at neutral
  kLimp,
  kIdle,     // limp because it had nothing to do for long (Servo::limp_after)
  kHot,      // limp because its health is 0
  kStopped,  // emergency stop
};
constexpr bool IsAlive(Activity a) noexcept {
  return a >= Activity::kFollowing && a <= Activity::kResting;
}

// By whose will one servo moves, and where to: a hand before the performer, and the contract when
// both are silent. Its times are its own: a servo that only the performer's wishes miss out is no
// exception. A hand counts as long as it repeats its wish at least every Contract::fresh, so a tool
// that dies lets go. Every change of will begins where the goal was: the difference fades.
class Aim {
 public:
  // From one will to another. Easing takes Contract::ease.
  static constexpr Duration kHandOver = std::chrono::milliseconds(300);

  // All must have passed FindFlaw; `step` is the bus's.
  void Configure(const Servo& servo, const ServoRig& rig, double step) noexcept;

  // All times are on one clock that never goes back. Positions are finite.
  void TakeWish(double position, Duration now, Duration interval) noexcept;  // as Follower::Take
  void TakeManual(double position, Duration now) noexcept;

  // kWaiting to kLimp.
  Activity Update(Duration now) noexcept;
  double goal() const noexcept { return goal_; }

 private:
  Activity Decide(Duration now) const noexcept;
  double Base(Duration now) const noexcept;  // the goal once the hand-over is done
  void Switch(Activity next, Duration now) noexcept;

  Contract contract_;
  double neutral_ = 0;
  Follower follower_;
  std::optional<Duration> last_wish_;
  std::optional<Duration> last_manual_;
  double manual_ = 0;

  Activity activity_ = Activity::kWaiting;
  double goal_ = 0;
  double held_ = 0;
  double offset_ = 0;  // of the goal from its base when the hand-over began
  Duration switched_{};
  Duration blend_{};
};

}  // namespace facewire::servo

#endif  // FACEWIRE_CORE_SERVO_AIM_H_
