#include "core/rig/rig.h"

namespace facewire {

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
