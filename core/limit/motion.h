#ifndef FACEWIRE_CORE_LIMIT_MOTION_H_
#define FACEWIRE_CORE_LIMIT_MOTION_H_

namespace facewire::limit {

// Where a channel is and how fast it moves. In double: the position is the sum of many small steps.
struct Motion {
  double position = 0;
  double speed_per_s = 0;  // signed
};

// 0 = unlimited, else positive and finite.
struct MotionLimits {
  double max_speed_per_s = 0;
  double max_acceleration_per_s2 = 0;
};

// The motion `dt_s` (>= 0) later, on the fastest way from `from` to rest at `target` that keeps the
// limits: speed up, cruise, brake. The way is followed in continuous time, so a step of 40 ms ends
// where two of 20 ms do, the target is reached exactly and in finite time, and irregular steps
// cannot make it swing. It passes the target only when `from` is too fast to stop before it; then
// it brakes and comes back. All arguments must be finite, |from.speed_per_s| at most the maximum
// speed.
Motion MoveTowards(double target, const Motion& from, const MotionLimits& limits,
                   double dt_s) noexcept;

}  // namespace facewire::limit

#endif  // FACEWIRE_CORE_LIMIT_MOTION_H_
