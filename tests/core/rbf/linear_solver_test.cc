#include "core/rbf/linear_solver.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
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

// Sizes around the panels that are eliminated together, and around the product's tiles.
constexpr std::size_t kSizes[] = {1, 2, 5, 12, 31, 32, 33, 64, 97, 131};

std::vector<double> Wild(std::size_t n) {
  std::minstd_rand random(static_cast<unsigned>(n));
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::vector<double> a(n * n);
  for (double& value : a) value = uniform(random);
  return a;
}

TEST(LinearSolver, SolvesSystemsOfAnySizeForAnyNumberOfColumns) {
  for (const std::size_t n : kSizes) {
    for (const std::size_t columns : {1U, 3U, 8U}) {
      const std::vector<double> a = Wild(n);
      Factorised f(a, n);
      ASSERT_TRUE(f.result) << n;
      std::vector<double> b(n * columns);
      for (std::size_t i = 0; i < b.size(); ++i) b[i] = std::cos(static_cast<double>(i * i));
      std::vector<double> x = b;
      f.solver.Solve(x, columns);
      for (std::size_t row = 0; row < n; ++row) {
        for (std::size_t c = 0; c < columns; ++c) {
          double sum = 0;
          for (std::size_t k = 0; k < n; ++k) sum += a[row * n + k] * x[k * columns + c];
          EXPECT_NEAR(sum, b[row * columns + c], 1e-8) << n << " " << row << " " << c;
        }
      }
    }
  }
}

TEST(LinearSolver, InverseDiagonalAgreesWithSolvingForUnitVectors) {
  for (const std::size_t n : kSizes) {
    Factorised f(Wild(n), n);
    ASSERT_TRUE(f.result);
    std::vector<double> inverse(n * n, 0.0);
    for (std::size_t k = 0; k < n; ++k) inverse[k * n + k] = 1;
    f.solver.Solve(inverse, n);
    std::vector<double> diagonal(n);
    f.solver.TakeInverseDiagonal(diagonal);
    for (std::size_t k = 0; k < n; ++k)
      EXPECT_NEAR(diagonal[k], inverse[k * n + k], 1e-8 * (1 + std::abs(diagonal[k]))) << n;
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
