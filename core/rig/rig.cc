#include "core/rig/rig.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace facewire {

float Channel::ValueOf(float sum) const noexcept {
  double value = neutral + Respond(response, sum);
  if (!std::isfinite(sum) || std::isnan(value)) return neutral;
  if (knee > 0) {
    const double width = double{knee} * (double{max} - min);
    value = ApproachFromBelow(value, max, std::min(width, double{max} - neutral));
    value = -ApproachFromBelow(-value, -double{min}, std::min(width, double{neutral} - min));
  }
  constexpr double kLargest = std::numeric_limits<float>::max();
  return static_cast<float>(std::clamp(value, -kLargest, kLargest));
}

std::optional<std::size_t> Rig::FindChannel(std::string_view channel) const noexcept {
  for (std::size_t i = 0; i < channels.size(); ++i) {
    if (channels[i].name.view() == channel) return i;
  }
  return std::nullopt;
}

RigPose Rig::NeutralPose() const noexcept {
  RigPose pose;
  pose.count = channels.size();
  for (std::size_t i = 0; i < channels.size(); ++i) pose.values[i] = channels[i].neutral;
  return pose;
}

}  // namespace facewire
