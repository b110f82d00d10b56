#ifndef FACEWIRE_TESTS_TOOLS_SHEET_RIGS_H_
#define FACEWIRE_TESTS_TOOLS_SHEET_RIGS_H_

#include <string_view>

#include "core/rig/rig.h"

namespace facewire::tools {

inline void AddChannel(Rig& rig, std::string_view name, ChannelKind kind, float min, float max) {
  Channel channel;
  channel.name = *ShortName::From(name);
  channel.kind = kind;
  channel.min = min;
  channel.max = max;
  ASSERT_TRUE(rig.channels.try_push(channel));
}

// A head with the bones that the character shows, named as those of the default rig.
inline Rig BoneRig() {
  Rig rig;
  AddChannel(rig, "jaw.pitch", ChannelKind::kPitch, -2, 24);
  AddChannel(rig, "upper_lid_L.pitch", ChannelKind::kPitch, -12, 45);
  AddChannel(rig, "upper_lid_R.pitch", ChannelKind::kPitch, -12, 45);
  AddChannel(rig, "lip_corner_L.y", ChannelKind::kPositionY, -1.6F, 1.6F);
  AddChannel(rig, "lip_corner_R.y", ChannelKind::kPositionY, -1.6F, 1.6F);
  AddChannel(rig, "neck.yaw", ChannelKind::kYaw, -60, 60);
  AddChannel(rig, "jawOpen", ChannelKind::kParameter, 0, 1);
  return rig;
}

inline void Set(const Rig& rig, RigPose& pose, std::string_view channel, float value) {
  pose.values[*rig.FindChannel(channel)] = value;
}

}  // namespace facewire::tools

#endif  // FACEWIRE_TESTS_TOOLS_SHEET_RIGS_H_
