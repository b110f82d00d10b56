#ifndef FACEWIRE_CORE_FACE_POSE_H_
#define FACEWIRE_CORE_FACE_POSE_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "core/base/capacity.h"
#include "core/base/geometry.h"
#include "core/base/time.h"

namespace facewire {

// Where the head is, and what the face does apart from that.
//
// Frames of reference, all right-handed:
//   head:   the canonical face's axes (object space): x to the person's left (right in
//           an unmirrored picture), y up, z out of the face; cm; origin as in the canonical face
//           model.
//   camera: origin at the camera, x to the right of the picture, y up, z from the scene to
//           the camera. A person facing the camera upright therefore has an identity rotation and a
//           translation with negative z.
struct FacePose {
  std::uint64_t seq = 0;
  Time captured{};
  float presence = 0;
  Matrix3 camera_R_head = kIdentity3;
  Point3 camera_t_head_cm{};
  float scale_px_per_cm = 0;                      // of the picture, at the head's distance
  std::size_t count = 0;                          // as in Landmarks
  std::array<Point3, kMaxLandmarks> points_cm{};  // in the head frame: head motion is removed
};
static_assert(std::is_trivially_copyable_v<FacePose>);

// Head rotation as angles in degrees, camera_R_head = Ry(yaw) Rx(pitch) Rz(roll). Positive yaw
// turns the face to the person's left, positive pitch nods it down, positive roll tilts its top to
// the person's right. yaw, roll in -180..180, pitch in -90..90.
struct HeadAngles {
  float pitch_deg = 0, yaw_deg = 0, roll_deg = 0;
};
HeadAngles AnglesOf(const Matrix3& camera_R_head) noexcept;  // core/pose

}  // namespace facewire

#endif  // FACEWIRE_CORE_FACE_POSE_H_
