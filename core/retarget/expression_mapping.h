#ifndef FACEWIRE_CORE_RETARGET_EXPRESSION_MAPPING_H_
#define FACEWIRE_CORE_RETARGET_EXPRESSION_MAPPING_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/base/arena.h"
#include "core/base/capacity.h"
#include "core/base/geometry.h"
#include "core/base/inline_vector.h"
#include "core/base/name.h"
#include "core/base/result.h"
#include "core/rbf/rbf.h"

namespace facewire::retarget {

// A part of the face with a function of its own: some markers in, some signals out. Regions keep
// apart what does not belong together (a blink moves no mouth) and let what matters weigh more.
struct RegionConfig {
  struct Gap {
    std::uint16_t upper = 0, lower = 0;  // indices of markers
  };
  ShortName name;
  rbf::RbfConfig rbf;
  // > 0: distances are taken in that many principal axes of the inputs (see rbf::PrincipalAxes).
  std::uint16_t axes = 0;
  float gap_gain = 1;  // multiplies the gaps below: how much more they count
  // Indices of markers. The inputs are the coordinates of `points` minus the mean of `origin` (when
  // there are any), then how far the upper marker of each gap is above the lower one; all in cm. A
  // gap has a sign, unlike a distance: lips that press closer than in a neutral with parted lips
  // must not read as open.
  InlineVector<std::uint16_t, kMaxMarkers> points, origin;
  InlineVector<Gap, kMaxRegionGaps> gaps;
  InlineVector<std::uint16_t, kMaxSignals> outputs;  // indices of signals

  constexpr std::size_t inputs() const noexcept { return 3 * points.size() + gaps.size(); }
};

// Example pairs, borrowed.
struct Training {
  std::span<const ShortName>
      markers;  // "lm0".."lm477": landmarks; any other names: a marker file's
  std::span<const ShortName> signals;
  std::span<const float> samples;         // samples x 3 markers by rows: x y z, cm, head frame
  std::span<const float> targets;         // samples x signals by rows, in the signals' own units
  std::span<const RegionConfig> regions;  // every signal is the output of exactly one
  std::size_t neutral_sample = 0;         // the row that is the face at rest
  // The samples are an average face: other performers are taken there by a geometry mapping first.
  bool average_user = false;

  std::size_t sample_count() const noexcept {
    return markers.empty() ? 0 : samples.size() / (3 * markers.size());
  }
};

// Which region could not be fitted, and why.
struct TrainingReport {
  std::size_t region = 0;
  rbf::FitReport fit;
};

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
  // The marker positions of the neutral sample, cm.
  std::span<const Point3> neutral_cm() const noexcept { return neutral_.span(); }
  bool average_user() const noexcept { return average_user_; }
  // Index of marker i in FacePose::points_cm: its landmark; for a marker file's names, i itself
  // (who reads the file then fills points_cm in this order).
  std::span<const std::int16_t> point_indices() const noexcept { return point_indices_.span(); }
  bool reads_landmarks() const noexcept { return reads_landmarks_; }
  float epsilon(std::size_t region) const noexcept { return regions_[region].rbf.epsilon(); }

  // `points_cm`: one per marker; `signals`: one per signal, overwritten, each within the range that
  // its training targets span (outside the trained region the function would run away; what is not
  // finite becomes the neutral sample's value). Not reentrant.
  void Evaluate(std::span<const Point3> points_cm, std::span<float> signals) const noexcept;

 private:
  struct Region {
    RegionConfig config;
    rbf::Rbf rbf;
    std::span<float> basis;  // axes x inputs; empty: inputs are used as they are
  };
  struct Range {
    float low = 0, high = 0, neutral = 0;
  };
  Result<> TakeNames(const Training& training) noexcept;
  Result<> FitRegion(Region& region, const Training& training, Arena& arena,
                     std::span<std::byte> workspace, rbf::FitReport& report,
                     std::span<float> leave_one_out) noexcept;
  void ReadInputs(const RegionConfig& region, std::span<const Point3> points_cm,
                  std::span<float> inputs) const noexcept;

  InlineVector<ShortName, kMaxMarkers> markers_;
  InlineVector<std::int16_t, kMaxMarkers> point_indices_;
  InlineVector<Point3, kMaxMarkers> neutral_;
  InlineVector<ShortName, kMaxSignals> signals_;
  InlineVector<Range, kMaxSignals> ranges_;
  InlineVector<Region, kMaxRegions> regions_;
  bool average_user_ = false;
  bool reads_landmarks_ = false;
};

}  // namespace facewire::retarget

#endif  // FACEWIRE_CORE_RETARGET_EXPRESSION_MAPPING_H_
