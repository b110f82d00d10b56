#include "core/servo/servo_rig.h"

#include <algorithm>
#include <cmath>

namespace facewire::servo {
namespace {

using Part = Flaw::Part;

// Beyond this a float no longer tells one step of a bus from the next.
constexpr float kLargest = 1e6F;
constexpr Duration kLongest = std::chrono::hours(24);
constexpr Duration kLongestLead = std::chrono::milliseconds(100);

// Comparisons with NaN are false, so these refuse NaN as well.
bool IsNumber(float value) noexcept { return std::abs(value) <= kLargest; }
bool IsWithin(float value, float min, float max) noexcept { return value >= min && value <= max; }
bool IsTime(Duration d) noexcept { return d >= Duration::zero() && d <= kLongest; }

bool IsMap(const Servo& servo) noexcept {
  const auto points = servo.map.span();
  if (points.size() < 2 || !IsNumber(servo.offset)) return false;
  const bool rises = points.back().out >= points.front().out;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!IsNumber(points[i].in) || !IsNumber(points[i].out)) return false;
    if (i == 0) continue;
    if (points[i].in <= points[i - 1].in) return false;
    if (rises ? points[i].out < points[i - 1].out : points[i].out > points[i - 1].out) return false;
  }
  return true;
}

bool IsRange(const Servo& s) noexcept {
  return IsNumber(s.min) && IsNumber(s.max) && s.min < s.max && IsWithin(s.neutral, s.min, s.max);
}

bool IsMotion(const Servo& s) noexcept {
  constexpr float kLargestRate = 1e9F;
  return s.max_speed_per_s > 0 && IsWithin(s.max_speed_per_s, 0, kLargestRate) &&
         IsWithin(s.max_acceleration_per_s2, 0, kLargestRate) && s.crawl_speed_per_s > 0 &&
         s.crawl_speed_per_s <= s.max_speed_per_s && IsTime(s.limp_after);
}

std::optional<Part> FlawOf(const Servo& s) noexcept {
  if (s.name.empty()) return Part::kName;
  if (s.bus.empty()) return Part::kAddress;
  if (!s.sources.empty() && !IsMap(s)) return Part::kMap;
  if (!IsRange(s)) return Part::kRange;
  const float range = s.max - s.min;
  if (!IsWithin(s.dead_band, 0, range) || !IsWithin(s.backlash, 0, range)) return Part::kBand;
  if (!IsMotion(s)) return Part::kMotion;
  return std::nullopt;
}

bool IsLinkage(const Linkage& linkage, const ServoRig& rig) noexcept {
  if (linkage.yields >= rig.servos.size() || linkage.other >= rig.servos.size()) return false;
  if (linkage.yields == linkage.other) return false;
  if (!IsNumber(linkage.gain) || !IsNumber(linkage.offset)) return false;
  const float bound = linkage.gain * rig.servos[linkage.other].neutral + linkage.offset;
  const float at = rig.servos[linkage.yields].neutral;
  return linkage.relation == Relation::kAtLeast ? at >= bound : at <= bound;
}

}  // namespace

double Servo::PositionOf(double sum) const noexcept {
  // Curves only rise: a falling one is a rising one of the negative positions.
  Response response;
  response.curve = map;
  const bool falls = !map.empty() && map[map.size() - 1].out < map[0].out;
  if (falls) {
    for (CurvePoint& point : response.curve) point.out = -point.out;
  }
  const double position = Respond(response, offset + sum);
  return falls ? -position : position;
}

std::optional<std::size_t> ServoRig::Find(std::string_view servo) const noexcept {
  for (std::size_t i = 0; i < servos.size(); ++i) {
    if (servos[i].name.view() == servo) return i;
  }
  return std::nullopt;
}

std::optional<Flaw> FindFlaw(const ServoRig& servos) noexcept {
  for (std::size_t i = 0; i < servos.servos.size(); ++i) {
    const Servo& servo = servos.servos[i];
    if (const auto part = FlawOf(servo)) return Flaw{*part, i, 0};
    for (std::size_t j = 0; j < servo.sources.size(); ++j) {
      if (!IsNumber(servo.sources[j].gain)) return Flaw{Part::kSource, i, j};
    }
    for (std::size_t j = 0; j < i; ++j) {
      const Servo& before = servos.servos[j];
      if (before.name == servo.name) return Flaw{Part::kName, i, j};
      if (before.bus == servo.bus && before.id == servo.id) return Flaw{Part::kAddress, i, j};
    }
  }
  for (std::size_t i = 0; i < servos.linkages.size(); ++i) {
    const Linkage& linkage = servos.linkages[i];
    if (!IsLinkage(linkage, servos)) return Flaw{Part::kLinkage, linkage.yields, i};
  }
  const Contract& c = servos.contract;
  for (const Duration d : {c.fresh, c.hold, c.ease, c.limp, c.stop_torque}) {
    if (!IsTime(d)) return Flaw{Part::kContract, 0, 0};
  }
  const Following& f = servos.following;
  if (!IsWithin(f.calm, 0, 100) || f.lead < Duration::zero() || f.lead > kLongestLead) {
    return Flaw{Part::kFollowing, 0, 0};
  }
  return std::nullopt;
}

std::optional<Flaw> FindFlaw(const ServoRig& servos, const Rig& rig) noexcept {
  if (const auto flaw = FindFlaw(servos)) return flaw;
  for (std::size_t i = 0; i < servos.servos.size(); ++i) {
    const auto sources = servos.servos[i].sources.span();
    for (std::size_t j = 0; j < sources.size(); ++j) {
      if (!rig.FindChannel(sources[j].channel.view())) return Flaw{Part::kSource, i, j};
    }
  }
  return std::nullopt;
}

}  // namespace facewire::servo
