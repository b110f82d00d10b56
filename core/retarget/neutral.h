#ifndef FACEWIRE_CORE_RETARGET_NEUTRAL_H_
#define FACEWIRE_CORE_RETARGET_NEUTRAL_H_

#include <array>
#include <cstddef>
#include <type_traits>

#include "core/base/capacity.h"
#include "core/base/geometry.h"

namespace facewire::retarget {

// A performer's face at rest, in the head frame, and where the head was (as in FacePose).
struct Neutral {
  std::size_t count = 0;  // as in FacePose
  std::array<Point3, kMaxLandmarks> points_cm{};
  Matrix3 camera_R_head = kIdentity3;
  Point3 camera_t_head_cm{};
};
static_assert(std::is_trivially_copyable_v<Neutral>);

}  // namespace facewire::retarget

#endif  // FACEWIRE_CORE_RETARGET_NEUTRAL_H_
