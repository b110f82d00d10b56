#ifndef FACEWIRE_CORE_RETARGET_EXPRESSION_MAPPING_H_
#define FACEWIRE_CORE_RETARGET_EXPRESSION_MAPPING_H_

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "core/base/arena.h"
#include "core/base/capacity.h"
#include "core/base/geometry.h"
#include "core/base/inline_vector.h"
#include "core/base/name.h"
#include "core/base/result.h"
#include "core/retarget/region.h"
#include "core/retarget/training.h"

namespace facewire::retarget {

// The paper's section 6: marker configuration -> every parameter of the rig, from example pairs.
class ExpressionMapping {
 public:
  // What Configure would say about the training before it solves anything; the two below are only
  // meant for trainings that pass.
  static Result<> Check(const Training& training) noexcept;
  // Bytes of arena that Configure needs, and of workspace that it needs only during the call.
  static std::size_t RequiredBytes(const Training& training) noexcept;
  static std::size_t WorkspaceBytes(const Training& training) noexcept;

  // Copies what it needs and solves all regions: load time, O(samples^3) a region.
  // kInvalidArgument: sizes that contradict each other, indices out of range, a signal in no region
  // or in two, markers that are landmarks only in part. kFull: a capacity of core/base/capacity.h
  // or the arena. kSingular: see `report`. `leave_one_out`: empty, or as targets: see
  // rbf::Rbf::Fit.
  Result<> Configure(const Training& training, Arena& arena, std::span<std::byte> workspace,
                     TrainingReport& report, std::span<float> leave_one_out = {}) noexcept;

  std::span<const ShortName> markers() const noexcept { return markers_.span(); }
  std::span<const ShortName> signals() const noexcept { return signals_.span(); }
  // How far each signal's targets are apart.
  std::span<const float> ranges() const noexcept { return ranges_.span(); }
  // The marker positions of the neutral sample, cm.
  std::span<const Point3> neutral_cm() const noexcept { return neutral_.span(); }
  bool average_user() const noexcept { return average_user_; }
  // Index of marker i in FacePose::points_cm: its landmark; for a marker file's names, i itself
  // (who reads the file then fills points_cm in this order).
  std::span<const std::int16_t> point_indices() const noexcept { return point_indices_.span(); }
  bool reads_landmarks() const noexcept { return reads_landmarks_; }
  float epsilon(std::size_t region) const noexcept { return regions_[region].epsilon(); }

  std::size_t region_count() const noexcept { return regions_.size(); }
  std::string_view region_name(std::size_t region) const noexcept {
    return regions_[region].config().name.view();
  }

  // `points_cm`: one per marker; `signals`: one per signal, overwritten, each within the range that
  // its training targets span. Far outside its training a region eases to the trained poses that
  // are most alike; what is not finite becomes the neutral sample's value. `novelty`: empty, or one
  // per region: how unlike its training it finds the face, unfamiliar above
  // TrainedSpace::kUnfamiliar. Not reentrant.
  void Evaluate(std::span<const Point3> points_cm, std::span<float> signals,
                std::span<float> novelty = {}) const noexcept;

 private:
  Result<> TakeNames(const Training& training) noexcept;

  InlineVector<ShortName, kMaxMarkers> markers_;
  InlineVector<std::int16_t, kMaxMarkers> point_indices_;
  InlineVector<Point3, kMaxMarkers> neutral_;
  InlineVector<ShortName, kMaxSignals> signals_;
  InlineVector<float, kMaxSignals> ranges_;  // one per signal
  InlineVector<Region, kMaxRegions> regions_;
  bool average_user_ = false;
  bool reads_landmarks_ = false;
};

}  // namespace facewire::retarget

#endif  // FACEWIRE_CORE_RETARGET_EXPRESSION_MAPPING_H_
