#include "core/track/region.h"

#include <algorithm>
#include <cmath>

namespace facewire::track {
namespace {

// Outer corners of the eyes in MediaPipe's mesh, image-left and image-right.
constexpr std::size_t kLeftCorner = 33;
constexpr std::size_t kRightCorner = 263;

// In pixels. No camera's picture is as large; far beyond it, float no longer counts pixels.
constexpr float kMaxCoordinate = 1e6F;

float AngleBetween(Point3 left, Point3 right) noexcept {
  return std::atan2(right.y - left.y, right.x - left.x);
}

Region Around(float min_x, float min_y, float max_x, float max_y, float angle) noexcept {
  return {.center_x_px = 0.5F * (min_x + max_x),
          .center_y_px = 0.5F * (min_y + max_y),
          .side_px = kRegionMargin * std::max(max_x - min_x, max_y - min_y),
          .angle_rad = angle};
}

}  // namespace

bool IsUsable(const Region& r) noexcept {
  // NaN fails every comparison.
  return std::abs(r.center_x_px) < kMaxCoordinate && std::abs(r.center_y_px) < kMaxCoordinate &&
         r.side_px > 1.0F && r.side_px < kMaxCoordinate && std::abs(r.angle_rad) < 4.0F;
}

Region RegionOf(const Detection& d) noexcept {
  return Around(d.min_x_px, d.min_y_px, d.max_x_px, d.max_y_px,
                AngleBetween(d.keypoints_px[0], d.keypoints_px[1]));
}

Region RegionOf(std::span<const Point3> landmarks_px) noexcept {
  Point3 min = landmarks_px[0];
  Point3 max = min;
  for (const Point3& p : landmarks_px) {
    min = {std::min(min.x, p.x), std::min(min.y, p.y), 0};
    max = {std::max(max.x, p.x), std::max(max.y, p.y), 0};
  }
  return Around(min.x, min.y, max.x, max.y,
                AngleBetween(landmarks_px[kLeftCorner], landmarks_px[kRightCorner]));
}

CropToPicture::CropToPicture(const Region& region, float crop_size) noexcept
    : scale_(region.side_px / crop_size),
      cos_(scale_ * std::cos(region.angle_rad)),
      sin_(scale_ * std::sin(region.angle_rad)),
      origin_x_(region.center_x_px - 0.5F * crop_size * (cos_ - sin_)),
      origin_y_(region.center_y_px - 0.5F * crop_size * (sin_ + cos_)) {}

Point3 CropToPicture::operator()(Point3 p) const noexcept {
  return Point3{origin_x_, origin_y_, 0} + Turn(p);
}

Point3 CropToPicture::Turn(Point3 p) const noexcept {
  return {cos_ * p.x - sin_ * p.y, sin_ * p.x + cos_ * p.y, scale_ * p.z};
}

}  // namespace facewire::track
