#ifndef FACEWIRE_TESTS_SUPPORT_GENERATED_FACE_H_
#define FACEWIRE_TESTS_SUPPORT_GENERATED_FACE_H_

#include <array>

#include "core/base/capacity.h"
#include "core/base/geometry.h"
#include "core/landmarks.h"

namespace facewire::test {

using FacePoints = std::array<Point3, kMaxLandmarks>;

// A face made of figures, for tests that need one of known shape: the pose fit's 33 landmarks lie
// on the canonical face exactly, all others on an ellipsoid of about its size, the same ones every
// time. Head frame of FacePose, cm.
FacePoints GeneratedFace();

// Ry(yaw) Rx(pitch) Rz(roll), as in HeadAngles.
Matrix3 Rotation(float pitch_deg, float yaw_deg, float roll_deg);

// How a picture was taken from far away (weak perspective): the point `rotation * face` in the
// head's axes lands `scale_px_per_cm` times as far from `origin_px`, where the head's origin lands.
struct View {
  Matrix3 rotation = kIdentity3;
  float scale_px_per_cm = 7;  // the face is then about 130 px high
  Point3 origin_px{320, 240, 0};
};
// kMaxLandmarks landmarks in a picture of 640 x 480, presence 1, seq 0, at the origin of time.
Landmarks Photograph(const FacePoints& face_cm, const View& view);

}  // namespace facewire::test

#endif  // FACEWIRE_TESTS_SUPPORT_GENERATED_FACE_H_
