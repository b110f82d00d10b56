#include "core/filter/plausibility.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

namespace facewire::filter {
namespace {

constexpr float kMinEyeDistanceSizes = 0.15F;
constexpr float kMinFaceHeightSizes = 0.3F;
constexpr float kShortestStepS = 1.F / 30;

// In MediaPipe's mesh.
constexpr std::size_t kOuterEyeCorners[] = {33, 263};
constexpr std::size_t kForehead = 10;
constexpr std::size_t kChin = 152;

float Distance(Point3 a, Point3 b) noexcept { return std::sqrt(Dot(a - b, a - b)); }

}  // namespace

std::optional<Extent> MeasureFace(const Landmarks& in, const PlausibilityConfig& config) noexcept {
  if (!(in.presence >= config.min_presence)) return std::nullopt;  // NaN too
  if (in.count != kMeshLandmarks && in.count != kMaxLandmarks) return std::nullopt;
  const std::span<const Point3> points(in.points_px.data(), in.count);
  if (!std::ranges::all_of(points, [](Point3 p) { return IsWithin(p, kMaxCoordinatePx); }))
    return std::nullopt;

  Point3 low = points[0];
  Point3 high = points[0];
  Point3 sum{};
  for (const Point3& p : points.first(kMeshLandmarks)) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), 0};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), 0};
    sum = sum + p;
  }
  const Extent face{.centre_px = (1.F / kMeshLandmarks) * sum,
                    .size_px = std::max(high.x - low.x, high.y - low.y),
                    .at = in.captured};
  if (!(face.size_px >= config.min_size_px)) return std::nullopt;

  const float eyes = Distance(points[kOuterEyeCorners[0]], points[kOuterEyeCorners[1]]);
  const float height = Distance(points[kForehead], points[kChin]);
  if (eyes < kMinEyeDistanceSizes * face.size_px) return std::nullopt;
  if (height < kMinFaceHeightSizes * face.size_px) return std::nullopt;
  return face;
}

bool Jumped(const Extent& from, const Extent& to, const PlausibilityConfig& config) noexcept {
  const float step_s = std::max(kShortestStepS, Seconds(Between(from.at, to.at)));
  const float moved =
      std::hypot(to.centre_px.x - from.centre_px.x, to.centre_px.y - from.centre_px.y);
  const float larger = std::max(from.size_px, to.size_px);
  const float smaller = std::min(from.size_px, to.size_px);
  return moved > config.max_speed_sizes_per_s * step_s * larger ||
         larger > config.max_size_ratio * smaller;
}

}  // namespace facewire::filter
