#ifndef FACEWIRE_CORE_RETARGET_RETARGETER_H_
#define FACEWIRE_CORE_RETARGET_RETARGETER_H_

#include <array>
#include <cstddef>
#include <string_view>

#include "core/base/arena.h"
#include "core/base/result.h"
#include "core/face_pose.h"
#include "core/rig/rig.h"
#include "core/rig_pose.h"

namespace facewire::retarget {

class ExpressionMapping;  // core/retarget/expression_mapping.h: a loaded profile

// A performer's face at rest, in the head frame, and where the head was.
struct Neutral {
  std::size_t count = 0;  // as in FacePose
  std::array<Point3, kMaxLandmarks> points_cm{};
  Point3 camera_t_head_cm{};
};

// Performer to character: geometry mapping for bones, expression mapping for signals, drives to channels.
class Retargeter {
 public:
  // Bytes of arena that Configure needs.
  static std::size_t RequiredBytes() noexcept;

  // Both are borrowed and must outlive the retargeter; `expressions` may be null (bones only).
  // kNotFound: a drive names a signal that neither the profile nor the head gives (FirstUnknownSignal tells).
  Result<> Configure(const Rig& rig, const ExpressionMapping* expressions, Arena& arena) noexcept;

  // Takes the performer's neutral and solves the mappings that depend on it. Allocates nothing; also
  // possible while running. kSingular: the neutral's points coincide or are not finite; the old neutral stays.
  Result<> SetNeutral(const Neutral& neutral) noexcept;

  // Before the first SetNeutral the performer counts as the average face.
  RigPose Update(const FacePose& face) noexcept;
};

}  // namespace facewire::retarget

#endif  // FACEWIRE_CORE_RETARGET_RETARGETER_H_
