#include "app/animatronic/servo_power.h"

#include <algorithm>
#include <span>

namespace facewire::app {

bool ServoPower::Allowed(const ServoReport& report, Time now) noexcept {
  if (report.bus_count == 0 || Between(report.at, now) > kFreshReport) return false;
  const auto buses = std::span(report.buses).first(report.bus_count);
  if (std::ranges::any_of(buses, [&](const ServoReport::Bus& bus) {
        return bus.closed && Between(*bus.closed, now) > patience_;
      })) {
    return false;
  }
  const auto servos = std::span(report.servos).first(report.servo_count);
  // Who fell silent before the last cut ended has been without power since.
  const bool stranded = std::ranges::any_of(servos, [&](const ServoReport::Servo& servo) {
    return servo.stranded && (!cut_until_ || *servo.stranded > *cut_until_) &&
           Between(*servo.stranded, now) > patience_;
  });
  if (stranded) cut_until_ = now + kCut;
  return !cut_until_ || now >= *cut_until_;
}

}  // namespace facewire::app
