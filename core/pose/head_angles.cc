#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/face_pose.h"

namespace facewire {

// Read off Ry(yaw) Rx(pitch) Rz(roll), whose second row is (cos p sin r, cos p cos r, -sin p) and
// whose third column is (sin y cos p, -sin p, cos y cos p).
HeadAngles AnglesOf(const Matrix3& r) noexcept {
  constexpr float kDegrees = 180 / std::numbers::pi_v<float>;
  // Looking straight up or down, yaw and roll turn about the same axis: call all of it yaw.
  constexpr float kStraight = 0.999999F;
  const float sin_pitch = std::clamp(-r[5], -1.F, 1.F);
  HeadAngles angles;
  angles.pitch_deg = kDegrees * std::asin(sin_pitch);
  if (std::abs(sin_pitch) > kStraight) {
    angles.yaw_deg = kDegrees * std::atan2(-r[6], r[0]);
    return angles;
  }
  angles.yaw_deg = kDegrees * std::atan2(r[2], r[8]);
  angles.roll_deg = kDegrees * std::atan2(r[3], r[4]);
  return angles;
}

}  // namespace facewire
