#ifndef FACEWIRE_TOOLS_GLTF_ANIMATION_H_
#define FACEWIRE_TOOLS_GLTF_ANIMATION_H_

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/rig/rig.h"
#include "core/rig_pose.h"

namespace facewire::tools {

// A character's performance as glTF 2.0; README.md of this folder says what the file holds. Keeps
// four bytes a channel and frame until Encode.
class GltfAnimation {
 public:
  explicit GltfAnimation(const Rig& rig);  // borrowed

  // The pose `t_us` after the recording's first frame. `head`: pitch, yaw, roll in degrees, x, y, z
  // in cm. A frame that is not later than the one before, to a float's precision of seconds, is
  // left out: glTF wants rising times.
  void Add(std::int64_t t_us, const std::array<float, 6>& head, const RigPose& pose);
  // A frame without a pose holds the one before; ahead of all others, the rig's neutral.
  void AddLost(std::int64_t t_us);

  std::size_t frames() const { return times_s_.size(); }
  // A whole .glb file, its animation under that name. Without frames it shows the character at rest
  // and has no animation. Throws Failure.
  std::string Encode(const std::string& name) const;

 private:
  std::span<const float> Values(std::size_t frame) const;

  const Rig& rig_;
  std::vector<float> times_s_;
  std::vector<float> values_;  // frames x (6 of the head, then the rig's channels)
};

}  // namespace facewire::tools

#endif  // FACEWIRE_TOOLS_GLTF_ANIMATION_H_
