#ifndef FACEWIRE_CORE_POSE_POSE_ESTIMATOR_H_
#define FACEWIRE_CORE_POSE_POSE_ESTIMATOR_H_

#include "core/base/result.h"
#include "core/face_pose.h"
#include "core/landmarks.h"

namespace facewire::pose {

struct PoseConfig {
  float vertical_fov_deg = 63.0F;  // of the camera; scales head.z only
};

// Separates head motion from expression.
class PoseEstimator {
 public:
  explicit PoseEstimator(const PoseConfig& config) noexcept;
  // kRejected: the points do not look like a face (degenerate, not finite).
  Result<FacePose> Update(const Landmarks& in) const noexcept;
};

}  // namespace facewire::pose

#endif  // FACEWIRE_CORE_POSE_POSE_ESTIMATOR_H_
