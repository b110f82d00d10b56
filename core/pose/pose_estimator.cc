#include "core/pose/pose_estimator.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <span>

#include "core/pose/canonical_face.h"
#include "core/pose/similarity_fit.h"

namespace facewire::pose {
namespace {

Matrix3 Transposed(const Matrix3& m) noexcept {
  return {m[0], m[3], m[6], m[1], m[4], m[7], m[2], m[5], m[8]};
}

Matrix3 Product(const Matrix3& a, const Matrix3& b) noexcept {
  Matrix3 out{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      out[3 * i + j] = a[3 * i] * b[j] + a[3 * i + 1] * b[3 + j] + a[3 * i + 2] * b[6 + j];
    }
  }
  return out;
}

// The smallest rotation that takes the viewing axis (0, 0, -1) to the ray through (x, y, -focal):
// I + K + K^2 / (1 + c) with K the cross-product matrix of axis x ray and c their cosine.
Matrix3 AxisToRay(float x, float y, float focal) noexcept {
  const float norm = std::sqrt(x * x + y * y + focal * focal);
  const float a = x / norm;
  const float b = y / norm;
  const float c = focal / norm;
  const float d = 1 / (1 + c);
  return {1 - a * a * d, -a * b * d, -a, -a * b * d, 1 - b * b * d, -b, a, b, c};
}

}  // namespace

Result<> Validate(const PoseConfig& config) noexcept {
  const bool valid = config.vertical_fov_deg >= 5 && config.vertical_fov_deg <= 150 &&
                     config.max_misfit >= 0 && config.max_misfit <= 1;
  if (!valid) return Errc::kOutOfRange;
  return {};
}

PoseEstimator::PoseEstimator(const PoseConfig& config) noexcept
    : focal_per_height_(0.5F / std::tan(config.vertical_fov_deg * std::numbers::pi_v<float> / 360)),
      max_misfit_(config.max_misfit) {}

Result<FacePose> PoseEstimator::Update(const Landmarks& in) const noexcept {
  if (in.count != kMeshLandmarks && in.count != kMaxLandmarks) return Errc::kRejected;
  if (in.width_px <= 0 || in.height_px <= 0) return Errc::kRejected;
  const std::span<const Point3> points(in.points_px.data(), in.count);
  if (!std::ranges::all_of(points, [](Point3 p) { return IsWithin(p, kMaxCoordinatePx); }))
    return Errc::kRejected;

  // The camera's axes, still in pixels: y up, z towards the camera, the origin in the picture's
  // middle.
  const float middle_x = static_cast<float>(in.width_px) / 2;
  const float middle_y = static_cast<float>(in.height_px) / 2;
  const auto in_camera_axes = [=](Point3 p) -> Point3 {
    return {p.x - middle_x, middle_y - p.y, -p.z};
  };

  std::array<PointPair, kCanonicalPoints> pairs{};
  for (std::size_t i = 0; i < kCanonicalPoints; ++i) {
    const CanonicalPoint& c = kCanonicalFace[i];
    pairs[i] = {c.position_cm, in_camera_axes(points[c.landmark]), c.weight};
  }
  const Result<Similarity> fit = FitSimilarity(pairs);
  if (!fit || fit->misfit > max_misfit_) return Errc::kRejected;

  FacePose out{.seq = in.seq, .captured = in.captured, .presence = in.presence};
  out.scale_px_per_cm = fit->scale;
  out.count = in.count;
  const Matrix3 head_R_fit = Transposed(fit->rotation);
  const float cm_per_px = 1 / fit->scale;
  for (std::size_t i = 0; i < in.count; ++i) {
    out.points_cm[i] =
        cm_per_px * (head_R_fit * (in_camera_axes(points[i]) - fit->to_centre)) + fit->from_centre;
  }

  // The fit's rotation is relative to the ray on which the camera sees the face.
  const float focal_px = focal_per_height_ * static_cast<float>(in.height_px);
  const Point3 seen = fit->to_centre;
  out.camera_R_head = Product(AxisToRay(seen.x, seen.y, focal_px), fit->rotation);
  const Point3 centre_cm = cm_per_px * Point3{seen.x, seen.y, -focal_px};
  out.camera_t_head_cm = centre_cm - out.camera_R_head * fit->from_centre;
  return out;
}

}  // namespace facewire::pose
