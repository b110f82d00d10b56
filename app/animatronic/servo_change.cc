#include "app/animatronic/servo_change.h"

#include <algorithm>
#include <tuple>

namespace facewire::app {
namespace {

auto Fixed(const servo::Servo& s) noexcept {
  return std::make_tuple(s.name.view(), s.bus.view(), s.id, s.min, s.max, s.neutral, s.dead_band,
                         s.backlash, s.max_speed_per_s, s.max_acceleration_per_s2,
                         s.crawl_speed_per_s, s.limp_after);
}
auto Fixed(const servo::Linkage& l) noexcept {
  return std::make_tuple(l.yields, l.other, l.relation, l.gain, l.offset);
}
auto Fixed(const servo::ServoRig& r) noexcept {
  return std::make_tuple(r.contract.fresh, r.contract.hold, r.contract.ease, r.contract.limp,
                         r.contract.stop_torque, r.following.calm, r.following.lead);
}

}  // namespace

bool SameButForMapping(const servo::ServoRig& a, const servo::ServoRig& b) noexcept {
  const auto same = [](const auto& x, const auto& y) { return Fixed(x) == Fixed(y); };
  return std::ranges::equal(a.servos, b.servos, same) &&
         std::ranges::equal(a.linkages, b.linkages, same) && same(a, b);
}

}  // namespace facewire::app
