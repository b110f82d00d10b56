#include "core/servo/mapper.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace facewire::servo {

Result<> Mapper::Configure(const ServoRig& servos, const Rig& rig) noexcept {
  if (FindFlaw(servos)) return Errc::kOutOfRange;
  if (FindFlaw(servos, rig)) return Errc::kNotFound;
  servos_ = servos.servos;
  for (std::size_t i = 0; i < servos_.size(); ++i) {
    const auto sources = servos_[i].sources.span();
    for (std::size_t j = 0; j < sources.size(); ++j) {
      channels_[i][j] = rig.FindChannel(sources[j].channel.view()).value_or(0);
    }
  }
  return {};
}

Wishes Mapper::Map(const RigPose& pose) const noexcept {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  Wishes wishes;
  wishes.seq = pose.seq;
  wishes.captured = pose.captured;
  wishes.count = servos_.size();
  for (std::size_t i = 0; i < servos_.size(); ++i) {
    const Servo& servo = servos_[i];
    double sum = servo.sources.empty() ? kNone : 0;
    for (std::size_t j = 0; j < servo.sources.size(); ++j) {
      const std::size_t channel = channels_[i][j];
      sum += channel < pose.count ? double{servo.sources[j].gain} * pose.values[channel] : kNone;
    }
    // A comparison with NaN is false, so clamp lets it pass.
    wishes.positions[i] =
        std::clamp(static_cast<float>(servo.PositionOf(sum)), servo.min, servo.max);
  }
  return wishes;
}

}  // namespace facewire::servo
