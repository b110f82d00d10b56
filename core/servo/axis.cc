#include "core/servo/axis.h"

#include <algorithm>
#include <cmath>

namespace facewire::servo {
namespace {

// Of a step; for the last bits of products that should be whole.
constexpr double kRounding = 1e-9;

}  // namespace

bool Axis::Configure(const Servo& servo, double step) noexcept {
  step_ = step;
  low_ = std::ceil(double{servo.min} / step - kRounding) * step;
  high_ = std::floor(double{servo.max} / step + kRounding) * step;
  speed_per_s_ = servo.max_speed_per_s;
  acceleration_per_s2_ = servo.max_acceleration_per_s2;
  crawl_part_ = double{servo.crawl_speed_per_s} / servo.max_speed_per_s;
  crawl_ = false;
  vigour_ = 1;
  if (low_ > high_) return false;
  Place(servo.neutral);
  return true;
}

double Axis::Inside(double position) const noexcept { return std::clamp(position, low_, high_); }

double Axis::Rounded(double position) const noexcept {
  return std::round(Inside(position) / step_) * step_;
}

void Axis::Place(double position) noexcept {
  command_ = std::round(Inside(position) / step_);
  motion_ = {command(), 0};
  since_change_s_ = 0;
}

double Axis::Acceleration() const noexcept {
  return crawl_ ? acceleration_per_s2_ * crawl_part_ : acceleration_per_s2_;
}

double Axis::Stop() const noexcept {
  const double a = Acceleration();
  const double v = motion_.speed_per_s;
  return a > 0 ? motion_.position + v * std::abs(v) / (2 * a) : motion_.position;
}

Span Axis::reach() const noexcept {
  const double stop = Stop();
  return {std::min(motion_.position, stop), std::max(motion_.position, stop)};
}

void Axis::Move(double goal, const Span& room, double dt_s) noexcept {
  if (dt_s <= 0) return;
  const double a = Acceleration();
  const double wanted = speed_per_s_ * std::min(vigour_, crawl_ ? crawl_part_ : 1);
  const double top = a > 0 ? std::max(wanted, std::abs(motion_.speed_per_s) - a * dt_s) : wanted;
  motion_.speed_per_s = std::clamp(motion_.speed_per_s, -top, top);

  const double target =
      Inside(room.low <= room.high ? std::clamp(goal, room.low, room.high) : Stop());
  motion_ = limit::MoveTowards(target, motion_, {top, a}, dt_s);

  since_change_s_ += dt_s;
  double most = std::floor(top * dt_s / step_ + kRounding);
  if (most < 1 && top * since_change_s_ >= step_ * (1 - kRounding)) most = 1;
  const double change =
      std::clamp(std::round(Inside(motion_.position) / step_) - command_, -most, most);
  if (change != 0) since_change_s_ = 0;
  command_ += change;
  motion_.position = std::clamp(motion_.position, command() - step_ / 2, command() + step_ / 2);
}

}  // namespace facewire::servo
