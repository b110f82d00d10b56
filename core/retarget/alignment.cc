#include "core/retarget/alignment.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace facewire::retarget {
namespace {

// Face mesh indices, of MediaPipe's canonical face; left and right are the person's own.
constexpr std::array<std::int16_t, 37> kRightEye = {
    33, 7,  163, 144, 145, 153, 154, 155, 133, 173, 157, 158, 159, 160, 161, 246, 130, 25, 110,
    24, 23, 22,  26,  112, 243, 190, 56,  28,  27,  29,  30,  247, 468, 469, 470, 471, 472};
constexpr std::array<std::int16_t, 37> kLeftEye = {
    263, 249, 390, 373, 374, 380, 381, 382, 362, 398, 384, 385, 386, 387, 388, 466, 359, 255, 339,
    254, 253, 252, 256, 341, 463, 414, 286, 258, 257, 259, 260, 467, 473, 474, 475, 476, 477};
constexpr std::array<std::int16_t, 20> kBrows = {70,  63,  105, 66,  107, 46,  53,  52,  65,  55,
                                                 300, 293, 334, 296, 336, 276, 283, 282, 295, 285};
constexpr std::array<std::int16_t, 11> kChin = {152, 148, 377, 176, 400, 175,
                                                199, 200, 171, 396, 18};

constexpr float kLeastDistance = 1e-3F;  // cm: below, two places count as one

bool IsFinite(Point3 p) noexcept {
  return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}

Point3 Mean(std::span<const Point3> points) noexcept {
  Point3 sum;
  for (const Point3 p : points) sum = sum + p;
  return (1.0F / static_cast<float>(points.size())) * sum;
}

// Root mean square distance from the mean.
float Spread(std::span<const Point3> points, Point3 mean) noexcept {
  float sum = 0;
  for (const Point3 p : points) sum += Dot(p - mean, p - mean);
  return std::sqrt(sum / static_cast<float>(points.size()));
}

std::optional<Point3> MeanOf(std::span<const Point3> points,
                             std::span<const std::int16_t> landmarks,
                             std::span<const std::int16_t> wanted) noexcept {
  Point3 sum;
  float count = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (std::ranges::find(wanted, landmarks[i]) == wanted.end()) continue;
    sum = sum + points[i];
    ++count;
  }
  if (count == 0) return std::nullopt;
  return (1.0F / count) * sum;
}

// Distance between two groups of landmarks along an axis; 0 when the points do not show both.
float Between(std::span<const Point3> points, std::span<const std::int16_t> landmarks,
              std::span<const std::int16_t> from, std::span<const std::int16_t> to,
              float Point3::*axis) noexcept {
  const auto a = MeanOf(points, landmarks, from);
  const auto b = MeanOf(points, landmarks, to);
  return a && b ? std::abs((*b).*axis - (*a).*axis) : 0.0F;
}

float Ratio(float target, float source, float otherwise) noexcept {
  return target > kLeastDistance && source > kLeastDistance ? target / source : otherwise;
}

// One axis may differ from the whole by a factor; by more, the two distances are an accident.
float Believable(float ratio, float overall) noexcept {
  constexpr float kMost = 4;
  return ratio > overall / kMost && ratio < overall * kMost ? ratio : overall;
}

}  // namespace

Result<Alignment> Align(std::span<const Point3> source, std::span<const Point3> target,
                        std::span<const std::int16_t> landmarks) noexcept {
  if (source.empty() || source.size() != target.size() || source.size() != landmarks.size() ||
      !std::ranges::all_of(source, IsFinite) || !std::ranges::all_of(target, IsFinite))
    return Errc::kInvalidArgument;
  Alignment out;
  out.source_mean = Mean(source);
  out.target_mean = Mean(target);
  const float spread = Spread(source, out.source_mean);
  if (source.size() > 1 && spread < kLeastDistance) return Errc::kSingular;
  const float overall = Ratio(Spread(target, out.target_mean), spread, 1.0F);
  const auto along = [&](std::span<const std::int16_t> from, std::span<const std::int16_t> to,
                         float Point3::*axis) {
    return Believable(Ratio(Between(target, landmarks, from, to, axis),
                            Between(source, landmarks, from, to, axis), overall),
                      overall);
  };
  out.scale.x = along(kRightEye, kLeftEye, &Point3::x);
  out.scale.y = along(kBrows, kChin, &Point3::y);
  out.scale.z = std::sqrt(out.scale.x * out.scale.y);
  return out;
}

}  // namespace facewire::retarget
