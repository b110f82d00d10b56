#ifndef FACEWIRE_CORE_RETARGET_RETARGETER_H_
#define FACEWIRE_CORE_RETARGET_RETARGETER_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "core/base/arena.h"
#include "core/base/result.h"
#include "core/face_pose.h"
#include "core/retarget/expression_mapping.h"
#include "core/retarget/geometry_mapping.h"
#include "core/retarget/neutral.h"
#include "core/rig/rig.h"
#include "core/rig_pose.h"

namespace facewire::retarget {

// The head's own signals, after those of the expression mapping: rotation in degrees and
// translation in cm from where the head was in the neutral capture, in the neutral head's axes.
inline constexpr std::array<std::string_view, 6> kHeadSignals = {
    "head.pitch", "head.yaw", "head.roll", "head.x", "head.y", "head.z"};

// The first signal that a drive of the rig names and neither the mapping (may be null) nor the head
// gives; nullopt when all are known.
std::optional<ShortName> FirstUnknownSignal(const Rig& rig,
                                            const ExpressionMapping* expressions) noexcept;

// Performer to character: geometry mapping for bones, expression mapping for signals, drives to
// channels.
class Retargeter {
 public:
  // Bytes of arena that Configure needs.
  static std::size_t RequiredBytes() noexcept;

  // Both are borrowed and must outlive the retargeter; `expressions` may be null (bones only).
  // kNotFound: a drive names a signal that neither the profile nor the head gives
  // (FirstUnknownSignal tells). kFull: the arena is too small.
  Result<> Configure(const Rig& rig, const ExpressionMapping* expressions, Arena& arena) noexcept;

  // Takes the performer's neutral and solves the mappings that depend on it. Allocates nothing;
  // also possible while running (a few ms). kSingular: the neutral's points coincide;
  // kInvalidArgument: they are not finite, or there are none. After an error the old neutral stays.
  Result<> SetNeutral(const Neutral& neutral) noexcept;

  // The expression mapping sees the motion from the performer's neutral, added to its own neutral
  // sample; for an average user that motion is mapped to the average's proportions first.
  // Before the first SetNeutral the performer counts as the average face, and bones stay at rest.
  // Points that the face or the neutral does not have (the light tracker sees no irises) count as
  // unmoved. What is not finite leaves its channels at neutral. Channels are not limited here.
  RigPose Update(const FacePose& face) noexcept;

  // Of the last Update: the mapping's signals in its order, then kHeadSignals.
  std::span<const float> signals() const noexcept {
    return std::span(signals_).first(signal_count_);
  }
  // Of the last Update, one per region of the mapping: see ExpressionMapping::Evaluate.
  std::span<const float> novelty() const noexcept {
    return std::span(novelty_).first(expressions_ == nullptr ? 0 : expressions_->region_count());
  }
  // Name of signals()[index].
  std::string_view signal_name(std::size_t index) const noexcept;

 private:
  // Everything that follows from a neutral. There are two, so that a neutral that cannot be solved
  // leaves the running one alone.
  struct Solution {
    Neutral neutral;
    GeometryMapping to_bones, to_average;
    InlineVector<Point3, kMaxBones> bones_at_neutral;      // to_bones of the neutral
    InlineVector<Point3, kMaxMarkers> markers_at_neutral;  // to_average of the neutral
  };
  struct BoneLink {
    std::int16_t bone = 0;
    std::int16_t landmark = 0;
  };
  struct SignalGain {
    std::uint16_t signal = 0;
    float gain = 0;
  };

  Result<> SolveBones(Solution& solution) noexcept;
  Result<> SolveAverage(Solution& solution) noexcept;
  void ReadExpressions(const FacePose& face) noexcept;
  void ReadHead(const FacePose& face) noexcept;
  void MoveBones(const FacePose& face) noexcept;
  float ChannelValue(std::size_t channel) const noexcept;

  const Rig* rig_ = nullptr;
  const ExpressionMapping* expressions_ = nullptr;
  InlineVector<BoneLink, kMaxBones> links_;  // bones with a landmark
  std::array<InlineVector<SignalGain, kMaxDrives>, kMaxChannels> gains_;
  std::array<Solution, 2> solutions_;
  std::size_t current_ = 0;
  bool has_neutral_ = false;
  std::span<std::byte> workspace_;

  std::array<float, kMaxSignals + kHeadSignals.size()> signals_{};
  std::size_t signal_count_ = 0;
  std::array<float, kMaxRegions> novelty_{};
  std::array<Point3, kMaxBones> offsets_cm_{};  // of bones from their rest, this frame
};

}  // namespace facewire::retarget

#endif  // FACEWIRE_CORE_RETARGET_RETARGETER_H_
