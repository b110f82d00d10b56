#include "core/wire/landmark_part.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace facewire::wire {
namespace {

std::int16_t Eighths(float px) noexcept {
  using Limits = std::numeric_limits<std::int16_t>;
  if (std::isnan(px)) return 0;
  const float eighths =
      std::clamp(8 * px, static_cast<float>(Limits::min()), static_cast<float>(Limits::max()));
  return static_cast<std::int16_t>(std::lround(eighths));
}

std::uint16_t Size(int px) noexcept {
  return static_cast<std::uint16_t>(
      std::clamp<int>(px, 0, std::numeric_limits<std::uint16_t>::max()));
}

}  // namespace

LandmarkPart PartOf(const Landmarks& landmarks, std::size_t first) noexcept {
  const std::size_t total = std::min(landmarks.count, kMaxLandmarks);
  const std::size_t begin = std::min(first, total);
  LandmarkPart part{.frame_seq = static_cast<std::uint32_t>(landmarks.seq),
                    .captured = landmarks.captured,
                    .width_px = Size(landmarks.width_px),
                    .height_px = Size(landmarks.height_px),
                    .total = static_cast<std::uint16_t>(total),
                    .first = static_cast<std::uint16_t>(begin)};
  (void)part.points.try_resize(std::min(total - begin, kMaxLandmarksInPart));  // always fits
  for (std::size_t i = 0; i < part.points.size(); ++i) {
    const Point3& point = landmarks.points_px[begin + i];
    part.points[i] = {.x_eighth_px = Eighths(point.x), .y_eighth_px = Eighths(point.y)};
  }
  return part;
}

}  // namespace facewire::wire
