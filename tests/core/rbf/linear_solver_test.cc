#include "core/rbf/linear_solver.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace facewire::rbf {
namespace {

struct Factorised {
  std::vector<double> matrix;
  std::vector<std::uint32_t> pivots;
  LinearSolver solver;
  Result<> result;

  explicit Factorised(std::vector<double> a, std::size_t n) : matrix(std::move(a)), pivots(n) {
    result = solver.Factorise(matrix, pivots);
  }
};

TEST(LinearSolver, SolvesASystemThatNeedsPivoting) {
  Factorised f({0, 2, 1, 1, 0, 3, 4, 1, 0}, 3);
  ASSERT_TRUE(f.result);
  // A (1, 2, 3)' = (7, 10, 6)', A (0, 1, 0)' = (2, 0, 1)'
  std::vector<double> b = {7, 2, 10, 0, 6, 1};
  f.solver.Solve(b, 2);
  const std::vector<double> expected = {1, 0, 2, 1, 3, 0};
  for (std::size_t i = 0; i < b.size(); ++i) EXPECT_NEAR(b[i], expected[i], 1e-12);
}

TEST(LinearSolver, InverseDiagonalAgreesWithSolvingForUnitVectors) {
  const std::size_t n = 12;
  std::vector<double> a(n * n);
  for (std::size_t i = 0; i < a.size(); ++i) a[i] = std::sin(1.7 * static_cast<double>(i * i));
  Factorised f(a, n);
  ASSERT_TRUE(f.result);
  std::vector<double> work(n);
  for (std::size_t k = 0; k < n; ++k) {
    std::vector<double> unit(n, 0.0);
    unit[k] = 1;
    f.solver.Solve(unit, 1);
    EXPECT_NEAR(f.solver.InverseDiagonal(k, work), unit[k], 1e-9) << k;
  }
}

TEST(LinearSolver, NamesTheColumnThatDependsOnThoseBefore) {
  // Column 2 = column 0 + column 1.
  Factorised f({1, 2, 3, 5, 0, 1, 1, 0, 4, 1, 5, 2, 2, 2, 4, 1}, 4);
  ASSERT_FALSE(f.result);
  EXPECT_EQ(f.result.error(), Errc::kSingular);
  EXPECT_EQ(f.solver.dependent_column(), 2U);
}

TEST(LinearSolver, RefusesWhatIsNotFinite) {
  Factorised f({1, 0, 0, std::numeric_limits<double>::infinity()}, 2);
  ASSERT_FALSE(f.result);
  EXPECT_EQ(f.result.error(), Errc::kInvalidArgument);
}

}  // namespace
}  // namespace facewire::rbf
