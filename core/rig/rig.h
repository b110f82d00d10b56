#ifndef FACEWIRE_CORE_RIG_RIG_H_
#define FACEWIRE_CORE_RIG_RIG_H_

#include <cstdint>
#include <optional>
#include <string_view>

#include "core/base/capacity.h"
#include "core/base/geometry.h"
#include "core/base/inline_vector.h"
#include "core/base/name.h"
#include "core/rig/response.h"
#include "core/rig_pose.h"

namespace facewire {

// What a channel's value means. The numbers are those of the wire (core/wire/README.md): append
// only.
enum class ChannelKind : std::uint8_t {
  kParameter = 0,  // a blend-shape weight or any named number; unit: the rig's, blend shapes 0..1
  kPositionX = 1,  // a bone's offset from its rest position, cm; axes as the head frame of FacePose
  kPositionY = 2,
  kPositionZ = 3,
  kPitch = 4,  // rotation of a bone from its rest, degrees; R = Ry(yaw) Rx(pitch) Rz(roll)
  kYaw = 5,
  kRoll = 6,
};
constexpr bool IsPosition(ChannelKind k) noexcept {
  return k >= ChannelKind::kPositionX && k <= ChannelKind::kPositionZ;
}
constexpr bool IsRotation(ChannelKind k) noexcept { return k >= ChannelKind::kPitch; }

// One part of the sum that drives a channel: gain * signal. Signals are the outputs of the
// expression mapping by name ("jawOpen"), and the head: "head.pitch", "head.yaw", "head.roll" in
// degrees, "head.x", "head.y", "head.z" in cm from where the head was in the neutral capture.
struct Drive {
  ShortName signal;
  float gain = 1;
};

// One number that the host receives: neutral + curve(gain * sum + bias), on soft knees towards its
// limits. The sum is that of its drives; for a position channel without drives, how far the
// geometry mapping moves its bone.
struct Channel {
  ShortName name;  // of the parameter ("jawOpen"), or "bone.axis" ("jaw.pitch")
  ChannelKind kind = ChannelKind::kParameter;
  std::int16_t bone = -1;  // index into Rig::bones; -1 for a parameter
  // Where the channel rests when no face drives it; min <= neutral <= max. A neutral face gives
  // neutral + curve(bias).
  float neutral = 0;
  float min = 0;
  float max = 1;
  // Half the width of the soft knee at each limit, as a part of max - min, 0 to 0.5; 0 = none. A
  // knee never reaches beyond neutral, so what is at rest stays where it is.
  float knee = 0;
  float max_speed_per_s = 0;          // in the channel's unit; 0 = unlimited
  float max_acceleration_per_s2 = 0;  // 0 = unlimited
  InlineVector<Drive, kMaxDrives> drives;
  Response response;

  // The value for a sum; monotone and continuous in it, finite for every finite sum. With a knee it
  // never leaves min to max; without one that is left to core/limit. A sum that is not finite gives
  // neutral.
  float ValueOf(float sum) const noexcept;
};

// A bone of the character. A bone with a landmark or marker is a sample of the geometry mapping:
// where that is in the performer's neutral corresponds to the bone's rest position.
struct Bone {
  ShortName name;
  Point3 rest_cm{};            // in the character's space
  std::int16_t landmark = -1;  // index into FacePose::points_cm; -1 = none, the bone rests
  // Of a recorded take, when the bone follows one that is no landmark of the face mesh; `landmark`
  // is then whatever place the take's reader gives it. Empty otherwise.
  ShortName marker{};
};

struct Rig {
  ShortName name;
  InlineVector<Bone, kMaxBones> bones;
  InlineVector<Channel, kMaxChannels> channels;

  std::optional<std::size_t> FindChannel(std::string_view channel) const noexcept;
  RigPose NeutralPose() const noexcept;  // seq 0, captured at the origin of time
};

}  // namespace facewire

#endif  // FACEWIRE_CORE_RIG_RIG_H_
