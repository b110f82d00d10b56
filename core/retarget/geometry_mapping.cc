#include "core/retarget/geometry_mapping.h"

#include <array>
#include <cmath>

namespace facewire::retarget {
namespace {

constexpr rbf::RbfConfig kConfig = {
    .kernel = rbf::Kernel::kMultiquadric,
    .tail = rbf::Tail::kLinear,
    .epsilon = 0.4F,  // per cm: a radius of 2.5 cm, more than twice the points' distance
    // Little enough for lids to close on lids also where the target's eyes are larger; enough for
    // touching lips, of which the target's stand 3 mm apart.
    .smoothing = 0.001F,
    // Next to nothing, so that a different scale along any axis is followed exactly; enough that
    // four points or fewer, or all in one plane, can be solved.
    .tail_smoothing = 0.01F};

constexpr rbf::RbfShape Shape(std::size_t points) noexcept {
  return {.samples = points, .inputs = 3, .outputs = 3, .tail = kConfig.tail};
}

}  // namespace

std::size_t GeometryMapping::RequiredBytes(std::size_t max_points) noexcept {
  return rbf::Rbf::RequiredBytes(Shape(max_points)) + 2 * (3 * max_points + 1) * sizeof(float);
}

std::size_t GeometryMapping::WorkspaceBytes(std::size_t max_points) noexcept {
  return rbf::Rbf::WorkspaceBytes(Shape(max_points));
}

Result<> GeometryMapping::Reserve(std::size_t max_points, Arena& arena) noexcept {
  samples_ = arena.MakeArray<float>(3 * max_points);
  targets_ = arena.MakeArray<float>(3 * max_points);
  if (samples_.empty() || targets_.empty()) return Errc::kFull;
  return residual_.Reserve(Shape(max_points), arena);
}

Result<> GeometryMapping::Solve(std::span<const Point3> source, std::span<const Point3> target,
                                std::span<const std::int16_t> landmarks,
                                std::span<std::byte> workspace) noexcept {
  const std::size_t n = source.size();
  if (3 * n > samples_.size()) return Errc::kFull;
  const auto aligned = Align(source, target, landmarks);
  if (!aligned) return aligned.error();
  alignment_ = *aligned;
  // The kernel's centimetre is the performer's: samples stay in the source space.
  for (std::size_t i = 0; i < n; ++i) {
    const Point3 left = target[i] - alignment_(source[i]);
    samples_[3 * i] = source[i].x;
    samples_[3 * i + 1] = source[i].y;
    samples_[3 * i + 2] = source[i].z;
    targets_[3 * i] = left.x;
    targets_[3 * i + 1] = left.y;
    targets_[3 * i + 2] = left.z;
  }
  rbf::FitReport report;
  return residual_.Fit(kConfig, Shape(n), samples_.first(3 * n), targets_.first(3 * n), workspace,
                       report);
}

Point3 GeometryMapping::Motion(const Anchor& anchor, Point3 p) const noexcept {
  const Point3 aligned = alignment_.Motion(p - anchor.source);
  Point3 motion = Map(p) - anchor.target;
  const float square = Dot(aligned, aligned);
  const float along = Dot(motion, aligned);
  if (along < 0) motion = motion - (along / square) * aligned;
  const float allowed = kMaxStretch * kMaxStretch * square;
  const float length = Dot(motion, motion);
  return length > allowed ? std::sqrt(allowed / length) * motion : motion;
}

Point3 GeometryMapping::Map(Point3 p) const noexcept {
  const std::array<float, 3> x = {p.x, p.y, p.z};
  std::array<float, 3> y{};
  residual_.Evaluate(x, y);
  return alignment_(p) + Point3{y[0], y[1], y[2]};
}

}  // namespace facewire::retarget
