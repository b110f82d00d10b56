#ifndef FACEWIRE_CORE_RBF_LINEAR_SOLVER_H_
#define FACEWIRE_CORE_RBF_LINEAR_SOLVER_H_

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/base/result.h"

namespace facewire::rbf {

// Dense LU factorisation with partial pivoting, P A = L U, in place on borrowed memory, in blocks.
// For load time: the cost is 2/3 n^3. Symmetric indefinite matrices (a tail makes them so) are the
// use, which is why this is not a Cholesky factorisation.
class LinearSolver {
 public:
  // `matrix` holds n x n values by rows and is overwritten with the factors; `pivots` has n
  // elements. kSingular: a pivot is below 1e-13 of the matrix's largest element, so that column
  // depends on those before it; dependent_column() says which. kInvalidArgument: sizes that
  // contradict each other, values that are not finite.
  Result<> Factorise(std::span<double> matrix, std::span<std::uint32_t> pivots) noexcept;

  // Solves A X = B in place; `b` holds n x columns values by rows. Only after Factorise, before
  // TakeInverseDiagonal.
  void Solve(std::span<double> b, std::size_t columns) const noexcept;

  // The diagonal of the inverse of A, n elements, at the cost of a factorisation. Works in the
  // factors' memory, so they are gone afterwards.
  void TakeInverseDiagonal(std::span<double> diagonal) noexcept;

  std::size_t size() const noexcept { return pivots_.size(); }
  std::size_t dependent_column() const noexcept { return dependent_column_; }

 private:
  Result<> FactorisePanel(std::size_t first, std::size_t width, double least_pivot) noexcept;
  void InvertUpper() noexcept;
  void InvertLower() noexcept;

  std::span<double> lu_;
  std::span<std::uint32_t> pivots_;  // row swapped with row k at step k
  std::size_t dependent_column_ = 0;
};

}  // namespace facewire::rbf

#endif  // FACEWIRE_CORE_RBF_LINEAR_SOLVER_H_
