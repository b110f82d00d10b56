#include "core/rbf/linear_solver.h"

#include <algorithm>
#include <cmath>

namespace facewire::rbf {
namespace {

// A pivot that elimination has eaten down to this part of its column is rounding noise: double has
// 2.2e-16, and n up to about 1400 rows add up.
constexpr double kRelativePivot = 1e-13;

// y += a * x. Apart, so that the compiler may vectorise it.
void Axpy(double a, const double* __restrict x, double* __restrict y, std::size_t n) noexcept {
  for (std::size_t i = 0; i < n; ++i) y[i] += a * x[i];
}

}  // namespace

Result<> LinearSolver::Factorise(std::span<double> matrix,
                                 std::span<std::uint32_t> pivots) noexcept {
  const std::size_t n = pivots.size();
  if (matrix.size() != n * n) return Errc::kInvalidArgument;
  lu_ = matrix;
  pivots_ = pivots;
  double* a = lu_.data();
  double scale = 0;
  for (const double value : lu_) scale = std::max(scale, std::abs(value));
  if (!std::isfinite(scale)) return Errc::kInvalidArgument;
  for (std::size_t k = 0; k < n; ++k) {
    std::size_t best = k;
    for (std::size_t row = k + 1; row < n; ++row)
      if (std::abs(a[row * n + k]) > std::abs(a[best * n + k])) best = row;
    pivots_[k] = static_cast<std::uint32_t>(best);
    // Negated so that NaN fails too.
    if (!(std::abs(a[best * n + k]) > kRelativePivot * scale)) {
      dependent_column_ = k;
      return Errc::kSingular;
    }
    if (best != k) std::swap_ranges(a + k * n, a + (k + 1) * n, a + best * n);
    const double inverse = 1.0 / a[k * n + k];
    for (std::size_t row = k + 1; row < n; ++row) {
      const double factor = a[row * n + k] * inverse;
      a[row * n + k] = factor;
      if (factor != 0) Axpy(-factor, a + k * n + k + 1, a + row * n + k + 1, n - k - 1);
    }
  }
  return {};
}

void LinearSolver::Solve(std::span<double> b, std::size_t columns) const noexcept {
  const std::size_t n = size();
  const double* a = lu_.data();
  double* x = b.data();
  for (std::size_t k = 0; k < n; ++k)
    if (pivots_[k] != k)
      std::swap_ranges(x + k * columns, x + (k + 1) * columns, x + pivots_[k] * columns);
  for (std::size_t row = 1; row < n; ++row)
    for (std::size_t k = 0; k < row; ++k)
      Axpy(-a[row * n + k], x + k * columns, x + row * columns, columns);
  for (std::size_t row = n; row-- > 0;) {
    for (std::size_t k = row + 1; k < n; ++k)
      Axpy(-a[row * n + k], x + k * columns, x + row * columns, columns);
    const double inverse = 1.0 / a[row * n + row];
    for (std::size_t c = 0; c < columns; ++c) x[row * columns + c] *= inverse;
  }
}

double LinearSolver::InverseDiagonal(std::size_t k, std::span<double> work) const noexcept {
  const std::size_t n = size();
  const double* a = lu_.data();
  std::ranges::fill(work, 0.0);
  std::size_t first = k;  // where P puts the one of the unit vector
  for (std::size_t step = 0; step < n; ++step) {
    if (pivots_[step] == step) continue;
    if (first == step) {
      first = pivots_[step];
    } else if (first == pivots_[step]) {
      first = step;
    }
  }
  work[first] = 1;
  // Everything before the one stays zero, and of the back substitution only row k is wanted.
  for (std::size_t row = first + 1; row < n; ++row) {
    double sum = 0;
    for (std::size_t c = first; c < row; ++c) sum += a[row * n + c] * work[c];
    work[row] = -sum;
  }
  for (std::size_t row = n; row-- > k;) {
    double sum = work[row];
    for (std::size_t c = row + 1; c < n; ++c) sum -= a[row * n + c] * work[c];
    work[row] = sum / a[row * n + row];
  }
  return work[k];
}

}  // namespace facewire::rbf
