#ifndef FACEWIRE_CORE_SERVO_AXIS_H_
#define FACEWIRE_CORE_SERVO_AXIS_H_

#include "core/limit/motion.h"
#include "core/servo/servo_rig.h"

namespace facewire::servo {

struct Span {
  double low = 0;
  double high = 0;
};

// The motion of one servo in commands that its bus can carry: whole steps, within its limits, never
// faster than its speed allows.
//
// A motion in continuous numbers keeps speed and acceleration (core/limit/motion.h); the command is
// the step next to it. Rounding alone would make steps of 2, 1, 2, 1 out of a motion of 1.5 a tick,
// so a tick moves the command by floor(speed * dt / step) steps at most; where that is 0, by one
// step as soon as speed * (time since its last change) is one. The motion waits for its command:
// they are never more than half a step apart. Hence, for every tick:
//     |change| <= speed * dt, or one step at speed * (time since the last change) >= 1 step
//     |change of change| <= acceleration * dt^2 + 2 steps    (steady ticks)
class Axis {
 public:
  // `step` > 0, the bus's; the servo must have passed FindFlaw. False when no whole step lies
  // within the servo's limits.
  bool Configure(const Servo& servo, double step) noexcept;

  // At rest on the step next to `position`, within the limits.
  void Place(double position) noexcept;
  // At rest where it is.
  void Freeze() noexcept { motion_.speed_per_s = 0; }
  // `crawl` only for a servo at rest: with less acceleration a moving one could not stop in time.
  void SetCrawl(bool crawl) noexcept { crawl_ = crawl; }
  bool crawls() const noexcept { return crawl_; }
  // Part of the full speed, > 0 to 1. A servo that is faster brakes down to it.
  void SetVigour(double part) noexcept { vigour_ = part; }

  // A tick of `dt_s` towards `goal` within `room`. An empty room (low > high): brakes.
  void Move(double goal, const Span& room, double dt_s) noexcept;

  double command() const noexcept { return command_ * step_; }
  double position() const noexcept { return motion_.position; }
  double step() const noexcept { return step_; }
  // All that the motion cannot avoid to visit: from here to where it could stop.
  Span reach() const noexcept;
  double Inside(double position) const noexcept;   // clamped to the limits, in whole steps
  double Rounded(double position) const noexcept;  // the command next to it

 private:
  double Acceleration() const noexcept;
  double Stop() const noexcept;  // where braking at once would end

  double low_ = 0;  // limits, both a whole number of steps
  double high_ = 0;
  double step_ = 1;
  double speed_per_s_ = 0;
  double acceleration_per_s2_ = 0;
  double crawl_part_ = 1;

  bool crawl_ = false;
  double vigour_ = 1;
  limit::Motion motion_;
  double command_ = 0;         // steps
  double since_change_s_ = 0;  // of the command
};

}  // namespace facewire::servo

#endif  // FACEWIRE_CORE_SERVO_AXIS_H_
