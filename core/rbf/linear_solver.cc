#include "core/rbf/linear_solver.h"

#include <algorithm>
#include <cmath>

#include "core/rbf/matrix_product.h"

namespace facewire::rbf {
namespace {

// A pivot that elimination has eaten down to this part of the largest element is rounding noise:
// double has 2.2e-16, and n up to about 1400 rows add up.
constexpr double kRelativePivot = 1e-13;
// Rows and columns that are eliminated together before the rest of the matrix hears of it.
constexpr std::size_t kPanel = 32;

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
  for (const double value : lu_) {
    if (!std::isfinite(value)) return Errc::kInvalidArgument;
    scale = std::max(scale, std::abs(value));
  }
  for (std::size_t first = 0; first < n; first += kPanel) {
    const std::size_t width = std::min(kPanel, n - first);
    if (auto done = FactorisePanel(first, width, kRelativePivot * scale); !done) return done;
    const std::size_t next = first + width;
    const std::size_t rest = n - next;
    for (std::size_t row = first + 1; row < next; ++row)
      for (std::size_t k = first; k < row; ++k)
        Axpy(-a[row * n + k], a + k * n + next, a + row * n + next, rest);
    AddProduct(-1, {a + next * n + first, n}, {a + first * n + next, n}, {a + next * n + next, n},
               rest, width, rest);
  }
  return {};
}

Result<> LinearSolver::FactorisePanel(std::size_t first, std::size_t width,
                                      double least_pivot) noexcept {
  const std::size_t n = size();
  const std::size_t end = first + width;
  double* a = lu_.data();
  for (std::size_t k = first; k < end; ++k) {
    std::size_t best = k;
    for (std::size_t row = k + 1; row < n; ++row)
      if (std::abs(a[row * n + k]) > std::abs(a[best * n + k])) best = row;
    pivots_[k] = static_cast<std::uint32_t>(best);
    // Negated so that NaN fails too.
    if (!(std::abs(a[best * n + k]) > least_pivot)) {
      dependent_column_ = k;
      return Errc::kSingular;
    }
    if (best != k) std::swap_ranges(a + k * n, a + (k + 1) * n, a + best * n);
    const double inverse = 1.0 / a[k * n + k];
    for (std::size_t row = k + 1; row < n; ++row) {
      const double factor = a[row * n + k] * inverse;
      a[row * n + k] = factor;
      Axpy(-factor, a + k * n + k + 1, a + row * n + k + 1, end - k - 1);
    }
  }
  return {};
}

void LinearSolver::Solve(std::span<double> b, std::size_t columns) const noexcept {
  const std::size_t n = size();
  double* a = lu_.data();
  double* x = b.data();
  for (std::size_t k = 0; k < n; ++k)
    if (pivots_[k] != k)
      std::swap_ranges(x + k * columns, x + (k + 1) * columns, x + pivots_[k] * columns);
  for (std::size_t first = 0; first < n; first += kPanel) {
    const std::size_t end = std::min(first + kPanel, n);
    AddProduct(-1, {a + first * n, n}, {x, columns}, {x + first * columns, columns}, end - first,
               first, columns);
    for (std::size_t row = first + 1; row < end; ++row)
      for (std::size_t k = first; k < row; ++k)
        Axpy(-a[row * n + k], x + k * columns, x + row * columns, columns);
  }
  for (std::size_t first = (n - 1) / kPanel * kPanel + kPanel; first > 0;) {
    const std::size_t end = std::min(first, n);
    first -= kPanel;
    AddProduct(-1, {a + first * n + end, n}, {x + end * columns, columns},
               {x + first * columns, columns}, end - first, n - end, columns);
    for (std::size_t row = end; row-- > first;) {
      for (std::size_t k = row + 1; k < end; ++k)
        Axpy(-a[row * n + k], x + k * columns, x + row * columns, columns);
      const double inverse = 1.0 / a[row * n + row];
      for (std::size_t c = 0; c < columns; ++c) x[row * columns + c] *= inverse;
    }
  }
}

// In place, panel of columns by panel: with the inverse V of the leading part known, the next panel
// of U^-1 is -V U inv(diagonal block). V is triangular, so row block r of that product needs the
// panel's rows from r down, which a walk from the top has not overwritten yet.
void LinearSolver::InvertUpper() noexcept {
  const std::size_t n = size();
  double* a = lu_.data();
  for (std::size_t first = 0; first < n; first += kPanel) {
    const std::size_t end = std::min(first + kPanel, n);
    for (std::size_t c = first; c < end; ++c) {  // the diagonal block itself
      const double inverse = 1.0 / a[c * n + c];
      for (std::size_t row = first; row < c; ++row) {
        double sum = 0;
        for (std::size_t k = row; k < c; ++k) sum += a[row * n + k] * a[k * n + c];
        a[row * n + c] = -sum * inverse;
      }
      a[c * n + c] = inverse;
    }
    for (std::size_t row = 0; row < first; ++row) {  // rows above: times -inverse, in place
      for (std::size_t c = end; c-- > first;) {
        double sum = 0;
        for (std::size_t k = first; k <= c; ++k) sum += a[row * n + k] * a[k * n + c];
        a[row * n + c] = -sum;
      }
    }
    for (std::size_t top = 0; top < first; top += kPanel) {
      const std::size_t below = top + kPanel;
      for (std::size_t row = top; row < below; ++row)
        for (std::size_t c = first; c < end; ++c) {
          double sum = 0;
          for (std::size_t k = row; k < below; ++k) sum += a[row * n + k] * a[k * n + c];
          a[row * n + c] = sum;
        }
      AddProduct(1, {a + top * n + below, n}, {a + below * n + first, n}, {a + top * n + first, n},
                 kPanel, first - below, end - first);
    }
  }
}

// The same for L, by panels of rows: the next panel of L^-1 is -inv(diagonal block) L V, and column
// block c of that product needs the panel's columns from c to the right.
void LinearSolver::InvertLower() noexcept {
  const std::size_t n = size();
  double* a = lu_.data();
  for (std::size_t first = 0; first < n; first += kPanel) {
    const std::size_t end = std::min(first + kPanel, n);
    for (std::size_t row = first; row < end; ++row)  // -inv(diagonal block) L, all to the left
      for (std::size_t c = 0; c < first; ++c) a[row * n + c] = -a[row * n + c];
    for (std::size_t row = first + 1; row < end; ++row)
      for (std::size_t k = first; k < row; ++k)
        Axpy(-a[row * n + k], a + k * n, a + row * n, first);
    for (std::size_t row = first + 1; row < end; ++row)  // the diagonal block itself
      for (std::size_t c = first; c < row; ++c) {
        double sum = a[row * n + c];
        for (std::size_t k = c + 1; k < row; ++k) sum += a[row * n + k] * a[k * n + c];
        a[row * n + c] = -sum;
      }
    for (std::size_t left = 0; left < first; left += kPanel) {
      const std::size_t right = left + kPanel;
      for (std::size_t row = first; row < end; ++row)
        for (std::size_t c = left; c < right; ++c) {
          double sum = a[row * n + c];
          for (std::size_t k = c + 1; k < right; ++k) sum += a[row * n + k] * a[k * n + c];
          a[row * n + c] = sum;
        }
      AddProduct(1, {a + first * n + right, n}, {a + right * n + left, n},
                 {a + first * n + left, n}, end - first, first - right, kPanel);
    }
  }
}

void LinearSolver::TakeInverseDiagonal(std::span<double> diagonal) noexcept {
  const std::size_t n = size();
  InvertUpper();
  InvertLower();
  const double* a = lu_.data();
  for (std::size_t k = 0; k < n; ++k) {
    std::size_t at = k;  // where P puts row k: the column of L^-1 P is L^-1's column `at`
    for (std::size_t step = 0; step < n; ++step) {
      if (pivots_[step] == step) continue;
      if (at == step) {
        at = pivots_[step];
      } else if (at == pivots_[step]) {
        at = step;
      }
    }
    double sum = k <= at ? a[k * n + at] : 0.0;  // times L^-1's own 1 at (at, at)
    for (std::size_t j = std::max(k, at + 1); j < n; ++j) sum += a[k * n + j] * a[j * n + at];
    diagonal[k] = sum;
  }
}

}  // namespace facewire::rbf
