#ifndef FACEWIRE_CORE_RETARGET_TRAINED_SPACE_H_
#define FACEWIRE_CORE_RETARGET_TRAINED_SPACE_H_

#include <cstddef>
#include <span>

#include "core/base/arena.h"
#include "core/base/result.h"
#include "core/nnls/basis.h"

namespace facewire::retarget {

// What a region has seen in training: how unlike that a face is, and what to show then.
//
// Novelty is the larger of two measures, each 1 for what is most unusual among the samples
// themselves:
//  * distance to the nearest sample, against that of the loneliest sample to its own nearest (that
//  differs). It
//    notices the gap that a missing pose leaves in a dense training;
//  * motion that the outputs do not explain: |d - B w| with the basis of nnls::Basis, against the
//    largest of the samples, or their typical distance where they are explained better than that.
//    It notices what a few single poses leave out, where every mixture is far from every sample.
// Rendered people and a real one whom the default profile does not know stay below 2.3; a jaw that
// opens, or an eye that closes, without a sample of it reaches 6 to 13.
class TrainedSpace {
 public:
  // Above this a face is unlike any trained pose.
  static constexpr float kUnfamiliar = 2.5F;
  // Here extrapolation has ended.
  static constexpr float kUnknown = 2 * kUnfamiliar;

  // Bytes of arena that Configure needs, and of workspace that it needs only during the call.
  static std::size_t RequiredBytes(const nnls::NnlsShape& shape) noexcept;
  static std::size_t WorkspaceBytes(const nnls::NnlsShape& shape) noexcept;

  // `samples`: samples x inputs by rows; `targets`: samples x outputs by rows; `neutral`: one of
  // the samples. kFull: the arena is too small; kInvalidArgument: the workspace is.
  Result<> Configure(const nnls::NnlsShape& shape, std::span<const float> samples,
                     std::span<const float> targets, std::size_t neutral, Arena& arena,
                     std::span<std::byte> workspace) noexcept;

  // To be called once for each sample, with the outputs that the region gives there.
  void Calibrate(std::span<const float> sample, std::span<const float> outputs) noexcept;

  // `squared_distances`: of x from every sample; empty: only unexplained motion counts. 0 for what
  // is not finite, and where the samples give no measure (all alike).
  float Novelty(std::span<const float> x, std::span<const float> outputs,
                std::span<const float> squared_distances) const noexcept;

  // Takes outputs from what they are, up to kUnfamiliar, to the targets of the samples nearest by,
  // from kUnknown on: the trained poses that are most alike, instead of extrapolation.
  void Ease(float novelty, std::span<const float> squared_distances,
            std::span<float> outputs) const noexcept;

 private:
  float Unexplained(std::span<const float> x, std::span<const float> outputs) const noexcept;

  nnls::NnlsShape shape_;
  std::span<float> rest_;          // inputs: of the neutral sample
  std::span<float> rest_outputs_;  // outputs: its targets
  std::span<float> basis_;         // outputs x inputs: motion that one unit of an output makes
  std::span<float> targets_;       // samples x outputs
  float typical_ = 0;              // median distance of a sample to its nearest
  float loneliest_ = 0;            // the largest
  float most_unexplained_ = 0;     // of the samples, at least typical_
};

}  // namespace facewire::retarget

#endif  // FACEWIRE_CORE_RETARGET_TRAINED_SPACE_H_
