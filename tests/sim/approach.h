#ifndef FACEWIRE_TESTS_SIM_APPROACH_H_
#define FACEWIRE_TESTS_SIM_APPROACH_H_

#include <algorithm>
#include <cmath>

namespace facewire::sim {

// A position that goes to its goal with limited speed and acceleration, as the controllers in the
// devices do it. One step is one unit of time; zero means no limit.
struct Approach {
  double position = 0;
  double speed = 0;

  void Step(double goal, double most_speed, double most_acceleration) {
    const double left = goal - position;
    const double whole = std::abs(left);
    double wanted = whole;  // what would arrive in this step
    if (most_speed > 0) wanted = std::min(wanted, most_speed);
    if (most_acceleration > 0) {
      // From this speed it can still stop in time, in steps: v + (v - a) + ... <= whole.
      const double half = most_acceleration / 2;
      wanted = std::min(wanted, std::sqrt(half * half + 2 * most_acceleration * whole) - half);
      const double change = std::copysign(wanted, left) - speed;
      speed += std::clamp(change, -most_acceleration, most_acceleration);
      if (std::abs(speed) <= most_acceleration && whole <= most_acceleration) speed = left;
    } else {
      speed = std::copysign(wanted, left);
    }
    position += speed;
    if (position == goal) speed = 0;
  }
  void Jump(double to) {
    position = to;
    speed = 0;
  }
  bool At(double goal) const { return position == goal && speed == 0; }
};

}  // namespace facewire::sim

#endif  // FACEWIRE_TESTS_SIM_APPROACH_H_
