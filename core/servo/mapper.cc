#include "core/servo/mapper.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace facewire::servo {

Result<> Mapper::Configure(const ServoRig& servos, const Rig& rig) noexcept {
  if (const auto flaw = FindFlaw(servos)) return Errc::kOutOfRange;
  if (const auto flaw = FindFlaw(servos, rig)) return Errc::kNotFound;
  servos_.clear();
  for (const servo::Servo& from : servos.servos) {
    Servo made;
    made.offset = from.offset;
    made.min = from.min;
    made.max = from.max;
    for (const Source& source : from.sources) {
      const auto channel = rig.FindChannel(source.channel.view());
      if (!channel || !made.terms.try_push({*channel, source.gain})) return Errc::kNotFound;
    }
    made.rising.curve = from.map;
    const bool falls =
        !from.map.empty() && made.rising.curve[from.map.size() - 1].out < made.rising.curve[0].out;
    made.direction = falls ? -1 : 1;
    for (CurvePoint& point : made.rising.curve) point.out *= static_cast<float>(made.direction);
    if (!servos_.try_push(made)) return Errc::kFull;
  }
  return {};
}

Wishes Mapper::Map(const RigPose& pose) const noexcept {
  Wishes wishes{.seq = pose.seq, .captured = pose.captured, .count = servos_.size()};
  for (std::size_t i = 0; i < servos_.size(); ++i) {
    const Servo& servo = servos_[i];
    double sum = servo.terms.empty() ? std::numeric_limits<double>::quiet_NaN() : servo.offset;
    for (const Term& term : servo.terms) {
      sum += term.channel < pose.count ? term.gain * double{pose.values[term.channel]}
                                       : std::numeric_limits<double>::quiet_NaN();
    }
    const double position = std::isnan(sum) ? sum : servo.direction * Respond(servo.rising, sum);
    // A comparison with NaN is false, so clamp lets it pass.
    wishes.positions[i] = std::clamp(static_cast<float>(position), servo.min, servo.max);
  }
  return wishes;
}

}  // namespace facewire::servo
