#include "core/rbf/principal_axes.h"

#include <algorithm>
#include <cmath>

#include "core/base/arena.h"
#include "core/rbf/matrix_product.h"

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

// Gram-Schmidt. One pass keeps the directions apart from each other, which is enough on the way;
// two make the basis orthonormal as far as double goes. A direction that vanishes (fewer directions
// of motion than axes) is replaced by a coordinate axis, so that the basis is always orthonormal.
void Orthonormalise(std::span<double> basis, std::size_t inputs, std::size_t axes,
                    int passes) noexcept {
  std::size_t spare = 0;
  for (std::size_t a = 0; a < axes; ++a) {
    double* row = basis.data() + a * inputs;
    while (true) {
      const double before = std::sqrt(Dot(row, row, inputs));
      for (int pass = 0; pass < passes; ++pass) {
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

// `mean` and `covariance` begin as zeros. `rows` and `columns`, each axes x inputs, hold as many
// centred samples at a time.
void MeasureCovariance(std::span<const float> samples, std::span<double> mean,
                       std::span<double> rows, std::span<double> columns,
                       std::span<double> covariance) noexcept {
  // Rows of the covariance that are found together, as far as their diagonal.
  constexpr std::size_t kBand = 32;
  const std::size_t inputs = mean.size();
  const std::size_t count = samples.size() / inputs;
  const std::size_t most = rows.size() / inputs;
  for (std::size_t s = 0; s < count; ++s)
    for (std::size_t i = 0; i < inputs; ++i) mean[i] += samples[s * inputs + i];
  for (double& m : mean) m /= static_cast<double>(count);
  for (std::size_t first = 0; first < count; first += most) {
    const std::size_t depth = std::min(most, count - first);
    for (std::size_t s = 0; s < depth; ++s)
      for (std::size_t i = 0; i < inputs; ++i)
        rows[s * inputs + i] = columns[i * depth + s] = samples[(first + s) * inputs + i] - mean[i];
    for (std::size_t band = 0; band < inputs; band += kBand) {
      const std::size_t end = std::min(band + kBand, inputs);
      AddProduct(1, {columns.data() + band * depth, depth}, {rows.data(), inputs},
                 {covariance.data() + band * inputs, inputs}, end - band, depth, end);
    }
  }
  for (std::size_t row = 0; row < inputs; ++row)
    for (std::size_t c = row + 1; c < inputs; ++c)
      covariance[row * inputs + c] = covariance[c * inputs + row];
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

  MeasureCovariance(samples, mean, current, next, covariance);
  // Start from mixtures of the coordinates' covariances: deterministic, and inside the space. Every
  // coordinate takes part, because some never move; the weights are such that no symmetry of a face
  // cancels a direction.
  for (std::size_t a = 0; a < axes; ++a)
    for (std::size_t i = 0; i < inputs; ++i)
      next[a * inputs + i] = std::cos(static_cast<double>((a + 1) * i * i));
  const auto multiply = [&](std::span<double> from, std::span<double> to) {
    std::ranges::fill(to, 0.0);
    AddProduct(1, {from.data(), inputs}, {covariance.data(), inputs}, {to.data(), inputs}, axes,
               inputs, inputs);
  };
  multiply(next, current);
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    Orthonormalise(current, inputs, axes, 1);
    multiply(current, next);
    std::swap(current, next);
  }
  Orthonormalise(current, inputs, axes, 2);
  std::ranges::transform(current, basis.begin(), [](double v) { return static_cast<float>(v); });
  return {};
}

}  // namespace facewire::rbf
