#ifndef FACEWIRE_CORE_RBF_RBF_H_
#define FACEWIRE_CORE_RBF_RBF_H_

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "core/base/arena.h"
#include "core/base/result.h"
#include "core/rbf/kernel.h"

namespace facewire::rbf {

// Value of RbfConfig::epsilon that stands for 1 / mean distance between two samples.
inline constexpr float kMeanDistanceEpsilon = -1;

struct RbfConfig {
  Kernel kernel = Kernel::kMultiquadric;
  Tail tail = Tail::kNone;  // the paper's equation 1 has none
  // Shape of the kernel, 1 / unit of the inputs: small = broad and smooth, large = local. 0 =
  // choose the one with the least leave-one-out error.
  float epsilon = 0;
  // 0 = through every sample exactly. Larger = flatter and less sensitive to noise in the samples;
  // in units of phi, added to the diagonal of H with the kernel's sign.
  float smoothing = 0;
  // The same for the tail: with 0 the tail is fitted freely, which needs samples in general
  // position and more of them than inputs.
  float tail_smoothing = 0;
};

// Numbers of samples, inputs of the function and outputs.
struct RbfShape {
  std::size_t samples = 0, inputs = 0, outputs = 0;
  Tail tail = Tail::kNone;
  // Columns of the polynomial tail.
  constexpr std::size_t tail_size() const noexcept {
    return tail == Tail::kNone ? 0 : tail == Tail::kConstant ? 1 : inputs + 1;
  }
};

// What Fit found, and why it failed.
struct FitReport {
  float epsilon = 0;  // the one used
  // Two samples with the same inputs (only an error without smoothing).
  std::optional<std::size_t> duplicate_first, duplicate_second;
  // A sample whose row of the system depends on those of the samples before it.
  std::optional<std::size_t> dependent_sample;
  // The samples do not determine the tail: too few, or all in one plane.
  bool tail_undetermined = false;
};

// A vector-valued function from scattered samples, the paper's equations 1 and 2:
//     y(x) = sum_i w_i phi(|x - x_i|) + tail(x),    H W = T,  H_ij = phi(|x_j - x_i|)
// with smoothing s and tail polynomials P (1, or 1 and the inputs):
//     [ H + sign s I   P         ] [W]   [T]
//     [ P'             -sign t I ] [C] = [0]       sign = SmoothingSign(kernel), t = tail_smoothing
// All outputs share one factorisation. Fit is for load time (double, O(n^3)); Evaluate is for every
// frame (float, no allocation). Memory is borrowed from an arena once.
class Rbf {
 public:
  // Bytes of arena that Reserve needs for at most this shape.
  static std::size_t RequiredBytes(const RbfShape& capacity) noexcept;
  // Bytes of workspace that Fit needs for this shape.
  static std::size_t WorkspaceBytes(const RbfShape& shape) noexcept;

  // kFull: the arena is too small.
  Result<> Reserve(const RbfShape& capacity, Arena& arena) noexcept;

  // `samples`: shape.samples x shape.inputs by rows; `targets`: shape.samples x shape.outputs by
  // rows. `leave_one_out`: empty, or samples x outputs: target minus what the other samples predict
  // there, by Rippa's formula w_k / inverse(A)_kk (Advances in Computational Mathematics 11, 1999).
  // kFull: shape exceeds the capacity. kInvalidArgument: sizes that contradict the shape, values
  // that are not finite, a workspace that is too small, negative numbers in the config. kSingular:
  // `report` says which samples are to blame. After an error the function is zero.
  Result<> Fit(const RbfConfig& config, const RbfShape& shape, std::span<const float> samples,
               std::span<const float> targets, std::span<std::byte> workspace, FitReport& report,
               std::span<float> leave_one_out = {}) noexcept;

  // `x`: inputs; `y`: outputs, overwritten; `squared_distances`: empty, or one per sample: from x,
  // in squared units of the inputs. Not reentrant: distances lie in the object's own memory.
  void Evaluate(std::span<const float> x, std::span<float> y,
                std::span<float> squared_distances = {}) const noexcept;

  const RbfShape& shape() const noexcept { return shape_; }
  float epsilon() const noexcept { return epsilon_; }

 private:
  struct Problem;
  Result<> ChooseEpsilon(const RbfConfig& config, Problem& problem) const noexcept;
  void Store(const Problem& problem) noexcept;

  RbfShape capacity_;
  RbfShape shape_;  // of the last Fit; samples == 0: none
  Kernel kernel_ = Kernel::kMultiquadric;
  float epsilon_ = 1;
  // What Evaluate multiplies with the weights: phi of every sample, then the tail's 1 and inputs,
  // each part padded with zeros to whole blocks.
  std::size_t tail_at_ = 0, stride_ = 0;
  std::span<float> origin_;   // inputs: mean of the samples, subtracted for precision
  std::span<float> centres_;  // blocks of samples x inputs x kBlock, in units of 1 / epsilon
  std::span<float> weights_;  // outputs x stride_
  std::span<float> terms_;    // stride_: of the point at hand
  std::span<float> point_;    // inputs: that point, in units of 1 / epsilon
};

}  // namespace facewire::rbf

#endif  // FACEWIRE_CORE_RBF_RBF_H_
