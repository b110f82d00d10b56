#include "core/rbf/principal_axes.h"

#include <algorithm>
#include <cmath>

#include "core/base/arena.h"

namespace facewire::rbf {
namespace {

// The subspace converges with the ratio of neighbouring variances to this power. A pair that is
// still mixed then has nearly equal variance, and it does not matter which of the two is kept.
constexpr int kIterations = 40;

void AddScaled(double a, const double* __restrict x, double* __restrict y, std::size_t n) noexcept {
  for (std::size_t i = 0; i < n; ++i) y[i] += a * x[i];
}

double Dot(const double* a, const double* b, std::size_t n) noexcept {
  double sum = 0;
  for (std::size_t i = 0; i < n; ++i) sum += a[i] * b[i];
  return sum;
}

// Gram-Schmidt, twice for precision. A direction that vanishes (fewer directions of motion than
// axes) is replaced by a coordinate axis, so that the basis is always orthonormal.
void Orthonormalise(std::span<double> basis, std::size_t inputs, std::size_t axes) noexcept {
  std::size_t spare = 0;
  for (std::size_t a = 0; a < axes; ++a) {
    double* row = basis.data() + a * inputs;
    while (true) {
      const double before = std::sqrt(Dot(row, row, inputs));
      for (int pass = 0; pass < 2; ++pass) {
        for (std::size_t b = 0; b < a; ++b) {
          const double* other = basis.data() + b * inputs;
          AddScaled(-Dot(row, other, inputs), other, row, inputs);
        }
      }
      const double length = std::sqrt(Dot(row, row, inputs));
      if (before > 0 && length > 1e-10 * before) {
        for (std::size_t i = 0; i < inputs; ++i) row[i] /= length;
        break;
      }
      if (spare == inputs) return;  // cannot happen: axes <= inputs
      std::fill_n(row, inputs, 0.0);
      row[spare++] = 1;
    }
  }
}

}  // namespace

Result<> PrincipalAxes(std::span<const float> samples, std::size_t inputs, std::size_t axes,
                       std::span<float> basis, std::span<std::byte> workspace) noexcept {
  if (axes == 0 || axes > inputs || basis.size() != axes * inputs || samples.empty() ||
      samples.size() % inputs != 0)
    return Errc::kInvalidArgument;
  Arena arena(workspace);
  const std::span<double> covariance = arena.MakeArray<double>(inputs * inputs);
  const std::span<double> mean = arena.MakeArray<double>(inputs);
  std::span<double> current = arena.MakeArray<double>(axes * inputs);
  std::span<double> next = arena.MakeArray<double>(axes * inputs);
  if (covariance.empty() || mean.empty() || current.empty() || next.empty())
    return Errc::kInvalidArgument;

  const std::size_t count = samples.size() / inputs;
  for (std::size_t s = 0; s < count; ++s)
    for (std::size_t i = 0; i < inputs; ++i) mean[i] += samples[s * inputs + i];
  for (double& m : mean) m /= static_cast<double>(count);
  const std::span<double> row = next.first(inputs);  // free until the iteration starts
  for (std::size_t s = 0; s < count; ++s) {
    for (std::size_t i = 0; i < inputs; ++i) row[i] = samples[s * inputs + i] - mean[i];
    for (std::size_t i = 0; i < inputs; ++i)
      AddScaled(row[i], row.data(), covariance.data() + i * inputs, inputs);
  }

  // Start from mixtures of the coordinates' covariances: deterministic, and inside the space. Every
  // coordinate takes part, because some never move; the weights are such that no symmetry of a face
  // cancels a direction.
  std::ranges::fill(current, 0.0);
  for (std::size_t a = 0; a < axes; ++a)
    for (std::size_t i = 0; i < inputs; ++i)
      AddScaled(std::cos(static_cast<double>((a + 1) * i * i)), covariance.data() + i * inputs,
                current.data() + a * inputs, inputs);
  Orthonormalise(current, inputs, axes);
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    std::ranges::fill(next, 0.0);
    for (std::size_t a = 0; a < axes; ++a)
      for (std::size_t i = 0; i < inputs; ++i)
        AddScaled(current[a * inputs + i], covariance.data() + i * inputs, next.data() + a * inputs,
                  inputs);
    std::swap(current, next);
    Orthonormalise(current, inputs, axes);
  }
  std::ranges::transform(current, basis.begin(), [](double v) { return static_cast<float>(v); });
  return {};
}

}  // namespace facewire::rbf
