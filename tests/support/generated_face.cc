#include "tests/support/generated_face.h"

#include <cmath>
#include <cstddef>
#include <numbers>

#include "core/pose/canonical_face.h"

namespace facewire::test {

FacePoints GeneratedFace() {
  FacePoints face{};
  // A golden-angle spiral covers the front of the ellipsoid evenly.
  constexpr float kGoldenAngle = 2.39996323F;
  for (std::size_t i = 0; i < face.size(); ++i) {
    const float radius = std::sqrt((static_cast<float>(i) + 0.5F) / kMaxLandmarks);
    const float angle = kGoldenAngle * static_cast<float>(i);
    const float x = radius * std::cos(angle);
    const float y = radius * std::sin(angle);
    face[i] = {7.5F * x, 9 * y, 8 * std::sqrt(1 - radius * radius) - 2};
  }
  face[152] = {0, -9, 4};  // the chin, which plausibility checks look at
  for (const pose::CanonicalPoint& point : pose::kCanonicalFace) {
    face[point.landmark] = point.position_cm;
  }
  return face;
}

Matrix3 Rotation(float pitch_deg, float yaw_deg, float roll_deg) {
  constexpr float kRadians = std::numbers::pi_v<float> / 180;
  const float cp = std::cos(kRadians * pitch_deg);
  const float sp = std::sin(kRadians * pitch_deg);
  const float cy = std::cos(kRadians * yaw_deg);
  const float sy = std::sin(kRadians * yaw_deg);
  const float cr = std::cos(kRadians * roll_deg);
  const float sr = std::sin(kRadians * roll_deg);
  return {cy * cr + sy * sp * sr, sy * sp * cr - cy * sr, sy * cp, cp * sr, cp * cr, -sp,
          cy * sp * sr - sy * cr, sy * sr + cy * sp * cr, cy * cp};
}

Landmarks Photograph(const FacePoints& face_cm, const View& view) {
  Landmarks out;
  out.width_px = 640;
  out.height_px = 480;
  out.presence = 1;
  out.count = kMaxLandmarks;
  for (std::size_t i = 0; i < face_cm.size(); ++i) {
    const Point3 p = view.scale_px_per_cm * (view.rotation * face_cm[i]);
    out.points_px[i] = {view.origin_px.x + p.x, view.origin_px.y - p.y, view.origin_px.z - p.z};
  }
  return out;
}

}  // namespace facewire::test
