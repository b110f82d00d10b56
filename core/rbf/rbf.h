#ifndef FACEWIRE_CORE_RBF_RBF_H_
#define FACEWIRE_CORE_RBF_RBF_H_

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/base/arena.h"
#include "core/base/result.h"
#include "core/rbf/config.h"

namespace facewire::rbf {

class System;

// A vector-valued function from scattered samples, the paper's equations 1 and 2:
//     y(x) = sum_i w_i phi(|x - x_i|) + tail(x),    H W = T,  H_ij = phi(|x_j - x_i|)
// with smoothing and a polynomial tail (see System, which solves it in double precision). All
// outputs share one factorisation. Fit is for load time (O(n^3)); Evaluate is for every frame
// (float, no allocation). Memory is borrowed from an arena once.
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
  // there (System::LeaveOneOut). `weights`: empty, or one per sample, > 0, by which its smoothing
  // is divided: a sample of weight 2 is the same sample twice. kFull: shape exceeds the capacity.
  // kInvalidArgument: sizes that contradict the shape, values that are not finite, a workspace that
  // is too small, negative numbers in the config other than its named ones. kSingular: the samples
  // do not determine the function, or so badly that rounding would show (more than kMaxRounding);
  // `report` says which samples are to blame. After an error the function is zero.
  //
  // kAutomaticEpsilon minimises the sum of squared leave-one-out errors plus what float would add
  // to them. It looks at 1 / mean distance times 1/16, 1/4, 1, 4 and 16, walks on while an end is
  // best (to 1/256 or 256 at most), then halves the step around the best three times, to a factor
  // of 1.2. What is singular or ill-conditioned is out, at the ends too; if nothing is left, the
  // error is that of 1 / mean distance. Kernels without a shape take 1 / mean distance, as
  // kMeanDistanceEpsilon does for all; 1 per unit if there is no distance.
  Result<> Fit(const RbfConfig& config, const RbfShape& shape, std::span<const float> samples,
               std::span<const float> targets, std::span<std::byte> workspace, FitReport& report,
               std::span<float> leave_one_out = {}, std::span<const float> weights = {}) noexcept;

  // How far Evaluate may be from the solution in double precision at any sample, as a part of the
  // largest target of that output. Points that nearly touch and pull apart, a little smoothing
  // between them, round by 0.002 and are sound; samples that nothing can tell apart round by more
  // than 1.
  static constexpr double kMaxRounding = 0.05;

  // `x`: inputs; `y`: outputs, overwritten; `squared_distances`: empty, or one per sample: from x,
  // in squared units of the inputs. Not reentrant: distances lie in the object's own memory.
  void Evaluate(std::span<const float> x, std::span<float> y,
                std::span<float> squared_distances = {}) const noexcept;

  const RbfShape& shape() const noexcept { return shape_; }
  float epsilon() const noexcept { return epsilon_; }

 private:
  void Store(const System& system, Kernel kernel) noexcept;
  bool AgreesAtSamples(const System& system, std::span<float> rounded,
                       std::span<double> allowed) const noexcept;

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
