#include "core/wire/pose.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace facewire::wire {

// In double: the width of a range of floats may exceed the largest float, and 65535 steps need
// every bit of a float's mantissa.
std::uint16_t Quantise(float value, float neutral, float min, float max) noexcept {
  const double width = double{max} - double{min};
  if (!(width > 0) || !std::isfinite(width)) return 0;
  if (std::isnan(value)) value = neutral;
  if (std::isnan(value)) return 0;
  const double part = (std::clamp(double{value}, double{min}, double{max}) - min) / width;
  return static_cast<std::uint16_t>(std::lround(part * 65535.0));
}

float Dequantise(std::uint16_t step, float min, float max) noexcept {
  const double width = double{max} - double{min};
  const auto value = static_cast<float>(min + step / 65535.0 * width);
  return min < max ? std::clamp(value, min, max) : min;
}

Pose MakePose(const Rig& rig, std::uint32_t rig_id, const RigPose& pose, ServiceState state,
              Time now) noexcept {
  Pose message;
  message.rig_id = rig_id;
  message.frame_seq = static_cast<std::uint32_t>(pose.seq);
  message.captured = pose.captured;
  if (now > pose.captured) {
    // Unsigned, because the difference of two signed times may overflow.
    const auto age = static_cast<std::uint64_t>(now.time_since_epoch().count()) -
                     static_cast<std::uint64_t>(pose.captured.time_since_epoch().count());
    constexpr std::uint64_t kMaxAge = std::numeric_limits<std::uint32_t>::max();
    message.age_us = static_cast<std::uint32_t>(std::min(age, kMaxAge));
  }
  message.state = state;
  for (std::size_t i = 0; i < rig.channels.size(); ++i) {
    const Channel& c = rig.channels[i];
    const float value = i < pose.count ? pose.values[i] : c.neutral;
    // A rig has no more channels than a pose has room for.
    (void)message.values.try_push(Quantise(value, c.neutral, c.min, c.max));
  }
  return message;
}

RigPose ValuesOf(const Pose& pose, const Rig& rig) noexcept {
  RigPose out = rig.NeutralPose();
  out.seq = pose.frame_seq;
  out.captured = pose.captured;
  const std::size_t sent = std::min(pose.values.size(), rig.channels.size());
  for (std::size_t i = 0; i < sent; ++i) {
    out.values[i] = Dequantise(pose.values[i], rig.channels[i].min, rig.channels[i].max);
  }
  return out;
}

}  // namespace facewire::wire
