#include "core/servo/follower.h"

#include <algorithm>
#include <cmath>

namespace facewire::servo {

void Follower::Configure(const Servo& servo, const Following& following, double step) noexcept {
  dead_band_ = servo.dead_band;
  turn_band_ = std::max(servo.dead_band, servo.backlash);
  tremble_ = double{following.calm} * std::max(turn_band_, step);
  lead_ = following.lead;
  Reset();
}

void Follower::Take(double wish, Duration now, Duration interval) noexcept {
  if (!started_) {
    started_ = true;
    calm_ = accepted_ = from_ = to_ = wish;
    direction_ = 0;
    began_ = now;
    duration_ = Duration::zero();
    return;
  }
  const Duration time = std::clamp(interval, kShortest, kLongest);
  const double left = wish - calm_;
  double part = 1;  // of the distance, by which the calm value moves
  if (tremble_ > 0) {
    const double kept = 1 / (1 + std::pow(left / tremble_, 4));
    part -= std::pow(std::min(kept, 1 - kCreep), 30 * double{Seconds(time)});
  }
  calm_ += part * left;

  const double offset = calm_ - accepted_;
  if (std::abs(offset) <= (offset * direction_ >= 0 ? dead_band_ : turn_band_)) return;
  from_ = GoalAt(now);
  // A slow motion leaves the band in every second or third frame only, and should not stop
  // in between. What was still for longer answers at once.
  const Duration gap = now - began_;
  duration_ = gap > 3 * time ? time : std::max(gap, time);
  began_ = now;
  direction_ = offset < 0 ? -1 : 1;
  accepted_ = calm_;
  // Noise is not carried on: its part is small where the motion is.
  to_ = accepted_ + part * part * left * double{Seconds(lead_)} / double{Seconds(time)};
}

double Follower::GoalAt(Duration now) const noexcept {
  const auto mix = [this](double a, double b, Duration t) {
    return a + (b - a) * static_cast<double>(t.count()) / static_cast<double>(duration_.count());
  };
  const Duration t = now - began_;
  if (t < duration_) return mix(from_, to_, t);
  if (t < 2 * duration_) return to_;  // the next wish is a little late
  if (t < 3 * duration_) return mix(to_, accepted_, t - 2 * duration_);
  return accepted_;
}

}  // namespace facewire::servo
