#ifndef FACEWIRE_CORE_POSE_POSE_ESTIMATOR_H_
#define FACEWIRE_CORE_POSE_POSE_ESTIMATOR_H_

#include "core/base/result.h"
#include "core/face_pose.h"
#include "core/landmarks.h"

namespace facewire::pose {

struct PoseConfig {
  // Of the camera, from the picture's top edge to its bottom edge; 5..150. Scales the head's
  // distance (z), and how much the rotation of a face beside the picture's middle is corrected for
  // the slanted view. The points in object space do not depend on it.
  float vertical_fov_deg = 63.0F;
  // A fit worse than this (Similarity::misfit) is not a face; 0..1. Real and rendered faces,
  // talking and turning: 0.14 at most. Landmarks pressed flat: 0.35; mirrored: 0.64; points at
  // random: above 0.9.
  float max_misfit = 0.3F;
};
// kOutOfRange: a number outside its range above.
Result<> Validate(const PoseConfig& config) noexcept;

// Separates head motion from expression: a similarity takes the canonical face
// (core/pose/canonical_face.h) to the landmarks. See README.md for why the fit is done in weak
// perspective.
class PoseEstimator {
 public:
  // The configuration must be valid.
  explicit PoseEstimator(const PoseConfig& config) noexcept;
  // kRejected: the points do not look like a face (not finite, degenerate, mirrored, scrambled),
  // their count is neither 468 nor 478, or the picture has no size.
  Result<FacePose> Update(const Landmarks& in) const noexcept;

 private:
  float focal_per_height_;  // focal length / picture height
  float max_misfit_;
};

}  // namespace facewire::pose

#endif  // FACEWIRE_CORE_POSE_POSE_ESTIMATOR_H_
