#ifndef FACEWIRE_TESTS_CORE_WIRE_TEST_RIG_H_
#define FACEWIRE_TESTS_CORE_WIRE_TEST_RIG_H_

#include "core/rig/rig.h"

namespace facewire::wire {

// A small character: two bones and four channels, one of each sort of range.
inline Rig TestRig() {
  Rig rig;
  rig.name = *ShortName::From("testrig");
  (void)rig.bones.try_push({.name = *ShortName::From("head"), .rest_cm = {0, 10, 0}});
  (void)rig.bones.try_push({.name = *ShortName::From("jaw"), .rest_cm = {0, -6.5F, 2}});
  const auto add = [&](const char* name, ChannelKind kind, std::int16_t bone, float neutral,
                       float min, float max) {
    Channel c;
    c.name = *ShortName::From(name);
    c.kind = kind;
    c.bone = bone;
    c.neutral = neutral;
    c.min = min;
    c.max = max;
    (void)rig.channels.try_push(c);
  };
  add("jaw.pitch", ChannelKind::kPitch, 1, 1.5F, -2, 22);
  add("head.yaw", ChannelKind::kYaw, 0, 0, -45, 45);
  add("jaw.y", ChannelKind::kPositionY, 1, 0, -3, 0.5F);
  add("jawOpen", ChannelKind::kParameter, -1, 0, 0, 1);
  return rig;
}

}  // namespace facewire::wire

#endif  // FACEWIRE_TESTS_CORE_WIRE_TEST_RIG_H_
