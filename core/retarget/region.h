#ifndef FACEWIRE_CORE_RETARGET_REGION_H_
#define FACEWIRE_CORE_RETARGET_REGION_H_

#include <cstddef>
#include <span>

#include "core/base/arena.h"
#include "core/base/geometry.h"
#include "core/base/result.h"
#include "core/nnls/nnls.h"
#include "core/rbf/rbf.h"
#include "core/retarget/soft_range.h"
#include "core/retarget/trained_space.h"
#include "core/retarget/training.h"

namespace facewire::retarget {

// One region of the expression mapping: reads its inputs from the markers, takes them to its axes
// and asks the function that its method has fitted.
class Region {
 public:
  // Bytes of arena that Configure needs, and of workspace that it needs only during the call.
  static std::size_t RequiredBytes(const RegionConfig& config, std::size_t samples) noexcept;
  static std::size_t WorkspaceBytes(const RegionConfig& config, std::size_t samples) noexcept;

  // `config` is one of training.regions and valid; errors and `leave_one_out` as in
  // ExpressionMapping::Configure, of which this is a part.
  Result<> Configure(const RegionConfig& config, const Training& training, Arena& arena,
                     std::span<std::byte> workspace, TrainingReport& report,
                     std::span<float> leave_one_out) noexcept;

  const RegionConfig& config() const noexcept { return config_; }
  const SoftRange& range(std::size_t output) const noexcept { return ranges_[output]; }
  float epsilon() const noexcept { return rbf_.epsilon(); }

  // `points_cm`: one per marker; `outputs`: one per output of the region, overwritten, each within
  // the range that its targets span. How unlike the training the face is there:
  // TrainedSpace::Novelty. Not reentrant.
  float Evaluate(std::span<const Point3> points_cm, std::span<float> outputs) const noexcept;

 private:
  Result<> Fit(std::span<const float> inputs, std::span<const float> targets, const Training& t,
               Arena& arena, std::span<std::byte> workspace, TrainingReport& report,
               std::span<float> leave_one_out) noexcept;
  // Outputs at a point of the region's axes, limited; fills distances_ where the method has them.
  void EvaluateAt(std::span<const float> x, std::span<float> outputs) const noexcept;
  void ReadInputs(std::span<const Point3> points_cm, std::span<float> inputs) const noexcept;

  RegionConfig config_;
  std::span<float> basis_;  // axes x inputs; empty: inputs are used as they are
  rbf::Rbf rbf_;
  nnls::Nnls nnls_;
  TrainedSpace space_;
  InlineVector<SoftRange, kMaxSignals> ranges_;  // one per output
  std::span<float> distances_;                   // squared, to every sample; empty without kRbf
};

}  // namespace facewire::retarget

#endif  // FACEWIRE_CORE_RETARGET_REGION_H_
