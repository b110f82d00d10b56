#ifndef FACEWIRE_CORE_NNLS_BASIS_H_
#define FACEWIRE_CORE_NNLS_BASIS_H_

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/base/arena.h"
#include "core/base/result.h"
#include "core/rbf/linear_solver.h"

namespace facewire::nnls {

// Numbers of samples, inputs of a function and outputs.
struct NnlsShape {
  std::size_t samples = 0, inputs = 0, outputs = 0;
};

// The motion of the inputs that a whole unit of each output makes, estimated from samples of both:
//     min |D - T B|^2,   D: inputs from the neutral's, T: targets from the neutral's in whole units
// Single poses give themselves back, mixed ones are taken apart. For load time: double, in a
// borrowed workspace that must outlive it.
class Basis {
 public:
  static std::size_t WorkspaceBytes(const NnlsShape& shape) noexcept;

  // kInvalidArgument: the arena is too small.
  Result<> Take(const NnlsShape& shape, Arena& arena) noexcept;

  // `samples`, `targets` and `neutral` as in Nnls::Fit. An output that no sample shows moves
  // nothing.
  Result<> Estimate(std::span<const float> samples, std::span<const float> targets,
                    std::size_t neutral) noexcept;

  // The motion of a whole unit, inputs; the unit: how far a target goes from the neutral's, or 1.
  std::span<const double> motion(std::size_t output) const noexcept {
    return basis_.subspan(output * shape_.inputs, shape_.inputs);
  }
  double unit(std::size_t output) const noexcept { return units_[output]; }

  // Makes the basis what it would be without this sample, which changes it by rank one; PutBack
  // takes that back.
  void LeaveOut(std::size_t sample) noexcept;
  void PutBack() noexcept { Change(1); }

 private:
  Result<> Solve() noexcept;
  void Change(double sign) noexcept;

  NnlsShape shape_;
  std::span<double> motion_;          // samples x inputs: D
  std::span<double> weights_;         // samples x outputs: T
  std::span<double> units_;           // outputs
  std::span<double> normal_;          // outputs x outputs: factors of T'T
  std::span<double> basis_;           // outputs x inputs: B
  std::span<double> column_, error_;  // outputs, inputs: their product is what LeaveOut takes away
  std::span<std::uint32_t> pivots_;
  rbf::LinearSolver solver_;
};

}  // namespace facewire::nnls

#endif  // FACEWIRE_CORE_NNLS_BASIS_H_
