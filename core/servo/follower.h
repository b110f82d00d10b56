#ifndef FACEWIRE_CORE_SERVO_FOLLOWER_H_
#define FACEWIRE_CORE_SERVO_FOLLOWER_H_

#include <chrono>

#include "core/base/time.h"
#include "core/servo/servo_rig.h"

namespace facewire::servo {

// Makes of one servo's wishes, which come at the camera's rate, a goal for any time in between.
//
// 1. Calm: a wish at the distance d from the calm value draws it nearer by the part
//        d^4 / (d^4 + h^4)   a 30th of a second,   h = calm * band, band = the larger of dead band,
//    backlash and step: as retarget::Steady, but steeper, because a single stray wish must not
//    leave the band. Motion passes, trembling is averaged; kCreep takes the last bit home.
// 2. Dead band: the goal stays where it is until the calm value has left it by more than the dead
//    band, or, against the direction of its last move, by more than the backlash if that is larger.
//    Then it goes all the way. So what stands still is off by less than the servo shows, for ever.
// 3. Straight line: from where the goal is to the new value, in the time that the camera took from
//    frame to frame. With a lead the line aims at where the motion will be so much later, and when
//    two frames have not come goes back to the last value.
// The lag behind a wish that moves steadily is therefore one interval of the camera less the lead.
class Follower {
 public:
  // Part of the distance a 30th of a second, however small.
  static constexpr double kCreep = 0.05;
  // Between frames; of the line's duration.
  static constexpr Duration kShortest = std::chrono::milliseconds(5);
  static constexpr Duration kUsual = std::chrono::microseconds(33'333);
  static constexpr Duration kLongest = std::chrono::milliseconds(100);

  // The step is the bus's. All must have passed FindFlaw.
  void Configure(const Servo& servo, const Following& following, double step) noexcept;
  // The next wish is taken as it is.
  void Reset() noexcept { started_ = false; }

  // A wish that comes at `now`, `interval` after the one before by the camera's time. Finite;
  // `now` never goes back.
  void Take(double wish, Duration now, Duration interval) noexcept;
  // Needs a wish.
  double GoalAt(Duration now) const noexcept;

 private:
  double dead_band_ = 0;
  double turn_band_ = 0;  // after a change of direction
  double tremble_ = 0;    // h
  Duration lead_{};

  bool started_ = false;
  double calm_ = 0;       // the calm value
  double accepted_ = 0;   // the calm value that the line leads to
  double direction_ = 0;  // of the last move: -1, 0 (none yet), 1
  double from_ = 0;
  double to_ = 0;  // accepted_ and the way that the lead adds
  Duration began_{};
  Duration duration_{};
};

}  // namespace facewire::servo

#endif  // FACEWIRE_CORE_SERVO_FOLLOWER_H_
