#ifndef FACEWIRE_CORE_POSE_CANONICAL_FACE_H_
#define FACEWIRE_CORE_POSE_CANONICAL_FACE_H_

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/base/geometry.h"

namespace facewire::pose {

// A landmark that moves with the skull more than with the expression, and how much to trust it.
struct CanonicalPoint {
  std::uint16_t landmark;  // index into Landmarks::points_px
  float weight;            // only their proportions matter; they add up to 1.055
  Point3 position_cm;      // on the canonical face, in the head frame of FacePose
};

inline constexpr std::size_t kCanonicalPoints = 33;

// The pose fit's landmarks of MediaPipe's canonical face model.
extern const std::array<CanonicalPoint, kCanonicalPoints> kCanonicalFace;

}  // namespace facewire::pose

#endif  // FACEWIRE_CORE_POSE_CANONICAL_FACE_H_
