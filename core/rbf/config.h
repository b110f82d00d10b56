#ifndef FACEWIRE_CORE_RBF_CONFIG_H_
#define FACEWIRE_CORE_RBF_CONFIG_H_

#include <cstddef>
#include <optional>

#include "core/rbf/kernel.h"

namespace facewire::rbf {

// Values of RbfConfig::epsilon that stand for a choice. The numbers are those of profile files.
inline constexpr float kAutomaticEpsilon = 0;  // the least leave-one-out error
// 1 / mean distance between two samples, over all pairs.
inline constexpr float kMeanDistanceEpsilon = -1;

struct RbfConfig {
  Kernel kernel = Kernel::kMultiquadric;
  Tail tail = Tail::kNone;  // the paper's equation 1 has none
  // Shape of the kernel, 1 / unit of the inputs: small = broad and smooth, large = local; or one of
  // the choices above.
  float epsilon = kAutomaticEpsilon;
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
  // Two samples with the same inputs, or so near each other that the rest cannot tell them apart.
  std::optional<std::size_t> duplicate_first, duplicate_second;
  // A sample whose row of the system depends, nearly or exactly, on those of other samples.
  std::optional<std::size_t> dependent_sample;
  // The samples do not determine the tail: too few, or all (nearly) in one plane.
  bool tail_undetermined = false;
};

}  // namespace facewire::rbf

#endif  // FACEWIRE_CORE_RBF_CONFIG_H_
