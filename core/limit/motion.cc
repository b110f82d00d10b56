#include "core/limit/motion.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace facewire::limit {
namespace {

// Only the speed is limited: a straight line to the target.
Motion Glide(double target, const Motion& from, double max_speed_per_s, double dt_s) noexcept {
  const double reach = max_speed_per_s * dt_s;
  const double distance = target - from.position;
  if (std::abs(distance) <= reach) return {target, 0};
  return {from.position + std::copysign(reach, distance), 0};
}

}  // namespace

Motion MoveTowards(double target, const Motion& from, const MotionLimits& limits,
                   double dt_s) noexcept {
  const double a = limits.max_acceleration_per_s2;
  if (a == 0 && limits.max_speed_per_s == 0) return {target, 0};
  if (a == 0) return Glide(target, from, limits.max_speed_per_s, dt_s);
  if (dt_s == 0 || (target == from.position && from.speed_per_s == 0)) return from;

  // Braking at once would end `stop` further on. The target lies ahead of that point or behind it;
  // turn the axis so that it lies ahead, which leaves one case: v -> peak, cruise, peak -> 0, with
  // v of either sign.
  const double stop = from.speed_per_s * std::abs(from.speed_per_s) / (2 * a);
  const double sign = target - from.position >= stop ? 1 : -1;
  const double distance = sign * (target - from.position);
  const double v = sign * from.speed_per_s;

  // The two ramps cover (2 peak^2 - v^2) / 2a; without a speed limit they are the whole distance.
  const double top =
      limits.max_speed_per_s > 0 ? limits.max_speed_per_s : std::numeric_limits<double>::infinity();
  const double peak = std::min(top, std::sqrt(std::max(0.0, a * distance + v * v / 2)));
  const double ramp_up_s = std::max(0.0, (peak - v) / a);
  const double ramps = (2 * peak * peak - v * v) / (2 * a);
  const double cruise_s = peak > 0 ? std::max(0.0, (distance - ramps) / peak) : 0;
  const double total_s = ramp_up_s + cruise_s + peak / a;

  if (dt_s >= total_s) return {target, 0};
  if (dt_s < ramp_up_s) {
    return {from.position + sign * (v * dt_s + a * dt_s * dt_s / 2), sign * (v + a * dt_s)};
  }
  if (dt_s < ramp_up_s + cruise_s) {
    const double ramp = (peak * peak - v * v) / (2 * a);
    return {from.position + sign * (ramp + peak * (dt_s - ramp_up_s)), sign * peak};
  }
  // Counted back from the target, so that rounding cannot let it stop beside it.
  const double left_s = total_s - dt_s;
  return {target - sign * a * left_s * left_s / 2, sign * a * left_s};
}

}  // namespace facewire::limit
