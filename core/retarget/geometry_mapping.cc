#include "core/retarget/geometry_mapping.h"

#include <array>

namespace facewire::retarget {
namespace {

constexpr rbf::RbfConfig kConfig = {.kernel = rbf::Kernel::kMultiquadric,
                                    .tail = rbf::Tail::kLinear,
                                    .epsilon = 1.0F,  // per cm
                                    .smoothing = 0.01F,
                                    // Damped, so that four points or fewer are enough.
                                    .tail_smoothing = 0.1F};

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

Point3 GeometryMapping::Map(Point3 p) const noexcept {
  const std::array<float, 3> x = {p.x, p.y, p.z};
  std::array<float, 3> y{};
  residual_.Evaluate(x, y);
  return alignment_(p) + Point3{y[0], y[1], y[2]};
}

}  // namespace facewire::retarget
