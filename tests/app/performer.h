#ifndef FACEWIRE_TESTS_APP_PERFORMER_H_
#define FACEWIRE_TESTS_APP_PERFORMER_H_

#include <cmath>

#include "core/face_pose.h"
#include "tests/support/generated_face.h"

namespace facewire::app {

// A generated face with eyes that are open, or closed to a part of that, and lips that are closed.
inline FacePose StillPerformer(float open = 1) {
  FacePose face;
  face.count = kMaxLandmarks;
  face.points_cm = test::GeneratedFace();
  face.camera_t_head_cm = {0, 0, -60};
  struct Eye {
    std::size_t upper, lower, outer, inner;
  };
  for (const Eye& eye : {Eye{159, 145, 33, 133}, Eye{386, 374, 263, 362}}) {
    const Point3 middle = 0.5F * (face.points_cm[eye.outer] + face.points_cm[eye.inner]);
    face.points_cm[eye.lower] = middle;
    face.points_cm[eye.upper] = middle + Point3{0, 0.9F * open, 0};
  }
  face.points_cm[78] = {-2.5F, -4, 4};
  face.points_cm[308] = {2.5F, -4, 4};
  face.points_cm[13] = face.points_cm[14] = {0, -4, 5};
  return face;
}

// What it does, as a function of the picture's time.
inline float Phase(const FacePose& face, float hz) {
  const auto us = face.captured.time_since_epoch().count() % 1'000'000'000;
  return 6.2831853F * hz * static_cast<float>(us) * 1e-6F;
}
inline void ShakeHead(FacePose& face) {
  face.camera_R_head = test::Rotation(0, 8 * std::sin(Phase(face, 1.5F)), 0);
}
inline void BlinkTwiceASecond(FacePose& face) {
  if (std::sin(Phase(face, 2)) > 0.8F) face.points_cm = StillPerformer(0.1F).points_cm;
}

}  // namespace facewire::app

#endif  // FACEWIRE_TESTS_APP_PERFORMER_H_
