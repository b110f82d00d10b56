#ifndef FACEWIRE_CORE_NNLS_NNLS_H_
#define FACEWIRE_CORE_NNLS_NNLS_H_

#include <cstddef>
#include <optional>
#include <span>

#include "core/base/arena.h"
#include "core/base/result.h"
#include "core/nnls/basis.h"

namespace facewire::nnls {

struct NnlsConfig {
  // How strongly weights are held back, in units of the basis' mean squared length. 0 = not at all,
  // which needs inputs that tell every output from the others.
  float ridge = 1e-6F;
};

// Why Fit failed.
struct NnlsReport {
  // Two samples with the same inputs and other targets (only an error without ridge).
  std::optional<std::size_t> duplicate_first, duplicate_second;
  // An output that moves no input, or moves them as those before it do.
  std::optional<std::size_t> dependent_output;
};

// Which blend shapes make this motion? (Choe, Lee and Ko, Performance-driven muscle-based facial
// animation, 2001: the previous work that the paper compares with.) Fit estimates a basis B, the
// motion of the inputs d = x - x_neutral that a whole unit of each output makes, from all samples
// by least squares, for one pose a sample as for mixed ones. Evaluate gives the w that minimise
//     |B w - d|^2 + ridge |w|^2,   each w between the least and the greatest of its targets,
// for blend shapes from 0 to their maximum: hence "non-negative". It is at home where motion adds
// up, and exact there even far from every sample.
//
// The start is the minimum without bounds, one product with a matrix; where that lies inside the
// bounds it is the answer. Else coordinates go downhill one by one, each as far as its bounds
// allow, until no output moves by more than 1e-4 of its range, at most 64 rounds. No state is kept
// between frames: the same input always gives the same output.
class Nnls {
 public:
  // Bytes of arena that Reserve needs, and of workspace that Fit needs.
  static std::size_t RequiredBytes(const NnlsShape& shape) noexcept;
  static std::size_t WorkspaceBytes(const NnlsShape& shape) noexcept;

  // kFull: the arena is too small.
  Result<> Reserve(const NnlsShape& shape, Arena& arena) noexcept;

  // `samples`: samples x inputs by rows; `targets`: samples x outputs by rows, in any units;
  // `neutral`: the sample that motion is measured from. `leave_one_out`: empty, or as targets:
  // target minus what a basis from the other samples gives there (really solved again each time,
  // within the bounds of all). Load time, double. kFull: not reserved for this shape.
  // kInvalidArgument: sizes that contradict the shape, values that are not finite, a workspace that
  // is too small, a negative ridge. kSingular: `report` says why.
  Result<> Fit(const NnlsConfig& config, const NnlsShape& shape, std::span<const float> samples,
               std::span<const float> targets, std::size_t neutral, std::span<std::byte> workspace,
               NnlsReport& report, std::span<float> leave_one_out = {}) noexcept;

  // `x`: inputs; `y`: outputs, overwritten. Not reentrant: works in the object's own memory.
  void Evaluate(std::span<const float> x, std::span<float> y) const noexcept;

 private:
  struct Problem;
  Result<> Store(const Problem& problem, double ridge, NnlsReport& report) noexcept;

  NnlsShape shape_;
  std::span<float> rest_;        // inputs: of the neutral sample
  std::span<float> solve_;       // outputs x inputs: from d to the minimum without bounds
  std::span<float> gram_;        // outputs x outputs: B'B + damping
  std::span<float> neutral_;     // outputs: targets of the neutral sample
  std::span<float> scale_;       // outputs: a whole unit, in which all weights below count
  std::span<float> low_, high_;  // outputs: bounds of the weights
  // Of the point at hand.
  std::span<float> motion_;                 // inputs: d
  std::span<float> pull_, slope_, weight_;  // outputs: B'd, B'd - gram w, w
};

}  // namespace facewire::nnls

#endif  // FACEWIRE_CORE_NNLS_NNLS_H_
