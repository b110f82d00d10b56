#ifndef FACEWIRE_CORE_RBF_SYSTEM_H_
#define FACEWIRE_CORE_RBF_SYSTEM_H_

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/base/arena.h"
#include "core/base/result.h"
#include "core/rbf/config.h"
#include "core/rbf/linear_solver.h"

namespace facewire::rbf {

// The linear system behind an Rbf, in double precision, in a borrowed workspace:
//     [ H + sign s / V P         ] [W]   [T]      H_ij = phi(epsilon |x_i - x_j|), T = targets
//     [ P'             -sign t I ] [C] = [0]      sign = SmoothingSign, t = tail smoothing
// with the samples' weights V on a diagonal and tail polynomials P: 1, or 1 and the inputs minus
// their mean. Inside, the inputs in P are in units of 1 / epsilon, which leaves the function as it
// is and the matrix of one size throughout.
class System {
 public:
  static std::size_t WorkspaceBytes(const RbfShape& shape) noexcept;

  // Borrows all four spans and measures distances; see Rbf::Fit. kInvalidArgument: sizes that
  // contradict the shape, values that are not finite, a workspace that is too small.
  Result<> Configure(const RbfShape& shape, std::span<const float> samples,
                     std::span<const float> targets, std::span<std::byte> workspace,
                     std::span<const float> weights = {}) noexcept;

  // Mean distance between two different samples; 0 if there is only one place.
  double mean_distance() const noexcept { return mean_distance_; }

  // Solves for this epsilon (the config's own is not read). kSingular: two samples in one place
  // without smoothing, a pivot that vanishes, or a condition beyond kMaxCondition; the report says
  // who is to blame.
  Result<> Solve(const RbfConfig& config, double epsilon, FitReport& report) noexcept;

  // Sum over samples and outputs of the squared leave-one-out errors w_k / inverse(A)_kk (Rippa,
  // Advances in Computational Mathematics 11, 1999); infinite when they are not finite. `errors`:
  // empty, or samples x outputs by rows: target minus what the others predict. Once after a Solve.
  double LeaveOneOut(std::span<float> errors) noexcept;

  // What float would add to that sum, at most about: the squared rounding errors of Rbf::Evaluate
  // at the samples, which grow with weights that cancel each other. After Solve.
  double ExpectedRounding() const noexcept;

  // The function that was solved for, y(x) in double precision. `x`: inputs; `y`: outputs.
  void Evaluate(std::span<const float> x, std::span<double> y) const noexcept;
  // The same at a sample, without a sum: the system's own equation says how far smoothing lets the
  // function pass from the target there. To within the residual of Solve, far below float.
  double AtSample(std::size_t sample, std::size_t output) const noexcept;

  // Blames whatever the system can hardly tell apart; only directly after Solve.
  void Blame(FitReport& report) noexcept;

  const RbfShape& shape() const noexcept { return shape_; }
  double epsilon() const noexcept { return epsilon_; }
  double mean(std::size_t input) const noexcept { return mean_[input]; }
  // Coefficient of a row (samples, then the tail in units of 1 / epsilon) for an output.
  double weight(std::size_t row, std::size_t output) const noexcept {
    return weights_[row * shape_.outputs + output];
  }
  // Largest absolute value of an output's targets.
  double largest_target(std::size_t output) const noexcept;
  std::span<const float> sample(std::size_t index) const noexcept {
    return samples_.subspan(index * shape_.inputs, shape_.inputs);
  }
  std::size_t size() const noexcept { return pivots_.size(); }

 private:
  void MeasureDistances() noexcept;
  double TailTerm(std::span<const float> x, std::size_t column) const noexcept;
  void FillMatrix(const RbfConfig& config) noexcept;
  double SmoothingOf(std::size_t sample) const noexcept {
    return sample_weights_.empty() ? smoothing_ : smoothing_ / sample_weights_[sample];
  }
  double EstimateCondition() noexcept;
  bool FindDuplicate(FitReport& report) const noexcept;

  RbfShape shape_;
  std::span<const float> samples_, targets_;
  std::span<const float> sample_weights_;  // empty: all 1
  std::span<double> squared_;              // samples x samples: squared distances
  std::span<double> mean_;                 // inputs
  std::span<double> matrix_;               // size x size: A, then its factors
  std::span<double> weights_;              // size x outputs
  std::span<double> work_;                 // size
  std::span<std::uint32_t> pivots_;
  LinearSolver solver_;
  Kernel kernel_ = Kernel::kMultiquadric;
  double smoothing_ = 0;  // with the kernel's sign
  double epsilon_ = 1, mean_distance_ = 0, largest_row_sum_ = 0, largest_element_ = 0;
};

}  // namespace facewire::rbf

#endif  // FACEWIRE_CORE_RBF_SYSTEM_H_
