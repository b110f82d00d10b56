#ifndef FACEWIRE_CORE_RBF_LINEAR_SOLVER_H_
#define FACEWIRE_CORE_RBF_LINEAR_SOLVER_H_

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/base/result.h"

namespace facewire::rbf {

// Dense LU factorisation with partial pivoting, P A = L U, in place on borrowed memory. For load
// time: the cost is 2/3 n^3. Symmetric indefinite matrices (a tail makes them so) are the use,
// which is why this is not a Cholesky factorisation.
class LinearSolver {
 public:
  // `matrix` holds n x n values by rows and is overwritten with the factors; `pivots` has n
  // elements. kSingular: a pivot is below 1e-13 of its column's largest element, so that column
  // depends on those before it; dependent_column() says which.
  Result<> Factorise(std::span<double> matrix, std::span<std::uint32_t> pivots) noexcept;

  // Solves A X = B in place; `b` holds n x columns values by rows.
  void Solve(std::span<double> b, std::size_t columns) const noexcept;

  // Element (k, k) of the inverse of A. `work` has n elements.
  double InverseDiagonal(std::size_t k, std::span<double> work) const noexcept;

  std::size_t size() const noexcept { return pivots_.size(); }
  std::size_t dependent_column() const noexcept { return dependent_column_; }

 private:
  std::span<double> lu_;
  std::span<std::uint32_t> pivots_;  // row swapped with row k at step k
  std::size_t dependent_column_ = 0;
};

}  // namespace facewire::rbf

#endif  // FACEWIRE_CORE_RBF_LINEAR_SOLVER_H_
