#ifndef FACEWIRE_CORE_RETARGET_RETARGETER_H_
#define FACEWIRE_CORE_RETARGET_RETARGETER_H_

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "core/base/arena.h"
#include "core/base/result.h"
#include "core/base/time.h"
#include "core/face_pose.h"
#include "core/retarget/expression_mapping.h"
#include "core/retarget/geometry_mapping.h"
#include "core/retarget/neutral.h"
#include "core/retarget/steady.h"
#include "core/rig/rig.h"
#include "core/rig_pose.h"

namespace facewire::retarget {

// The head's own signals, after those of the expression mapping: rotation in degrees and
// translation in cm from where the head was in the neutral capture, in the neutral head's axes.
inline constexpr std::array<std::string_view, 6> kHeadSignals = {
    "head.pitch", "head.yaw", "head.roll", "head.x", "head.y", "head.z"};

// The first signal that a drive of the rig names and neither one of the mappings (may be null) nor
// the head gives; nullopt when all are known.
std::optional<ShortName> FirstUnknownSignal(const Rig& rig, const ExpressionMapping* expressions,
                                            const ExpressionMapping* personal = nullptr) noexcept;

// The blend of a personal profile takes so long from one end to the other: a lever that is thrown
// must not throw the puppet.
inline constexpr Duration kBlendTime = std::chrono::milliseconds(500);

// Performer to character: geometry mapping for bones, expression mapping for signals, drives to
// channels.
class Retargeter {
 public:
  // Bytes of arena that Configure needs.
  static std::size_t RequiredBytes() noexcept;

  // The rig and the mappings are borrowed and must outlive the retargeter. `expressions` may be
  // null (without `personal`: bones only). `personal`: a profile of this performer's own poses,
  // blended over `expressions`; null: none. Markers of a marker file are found by name among those
  // of `expressions`. kNotFound: a drive names a signal that neither a profile nor the head gives
  // (FirstUnknownSignal tells). kUnsupported: `personal` reads other markers than FacePose will
  // hold for `expressions`. kFull: the arena is too small.
  Result<> Configure(const Rig& rig, const ExpressionMapping* expressions, Arena& arena,
                     const ExpressionMapping* personal = nullptr) noexcept;

  bool has_personal() const noexcept { return personal_.mapping != nullptr; }
  // How much the personal profile counts: 0 (not at all) to 1 (alone, where it gives a signal), 1
  // from Configure on. What lies outside is clamped, NaN changes nothing. Before the first Update
  // at once, later over kBlendTime. A signal that only the personal profile gives fades with it.
  void SetBlend(float blend) noexcept;
  float blend() const noexcept { return blend_goal_; }  // as set; where it goes to

  // Takes the performer's neutral and solves the mappings that depend on it. Allocates nothing;
  // also possible while running (a few ms). kSingular: the neutral's points coincide;
  // kInvalidArgument: they are not finite, or there are none. After an error the old neutral stays.
  Result<> SetNeutral(const Neutral& neutral) noexcept;

  // An expression mapping sees the motion from the performer's neutral, added to its own neutral
  // sample; for an average user and the personal profile that motion is mapped to the profile's
  // proportions first.
  // Before the first SetNeutral the performer counts as the profiles' faces, and bones stay at
  // rest. Points that the face or the neutral does not have (the light tracker sees no irises)
  // count as unmoved. What is not finite leaves its channels at neutral. Values are
  // Channel::ValueOf: the hard limits are left to core/limit.
  RigPose Update(const FacePose& face) noexcept;

  // Of the last Update: the signals of `expressions` in its order, then those that only `personal`
  // gives in its order, then kHeadSignals.
  std::span<const float> signals() const noexcept {
    return std::span(signals_).first(signal_count_);
  }
  // Of the last Update, one per region of `expressions`: see ExpressionMapping::Evaluate.
  std::span<const float> novelty() const noexcept {
    return std::span(novelty_).first(shared_.mapping == nullptr ? 0
                                                                : shared_.mapping->region_count());
  }
  // Name of signals()[index].
  std::string_view signal_name(std::size_t index) const noexcept;

 private:
  // A profile and how it finds its markers.
  struct Source {
    const ExpressionMapping* mapping = nullptr;  // null: none
    // The performer's neutral is taken to the profile's by a geometry mapping.
    bool adapted = false;
    InlineVector<std::int16_t, kMaxMarkers> points;  // index into FacePose::points_cm by marker
  };
  struct Adaptation {
    GeometryMapping to_profile;
    InlineVector<GeometryMapping::Anchor, kMaxMarkers> anchors;  // of to_profile
  };
  // Everything that follows from a neutral. There are two, so that a neutral that cannot be solved
  // leaves the running one alone.
  struct Solution {
    Neutral neutral;
    GeometryMapping to_bones;
    InlineVector<GeometryMapping::Anchor, kMaxBones> bone_anchors;  // of to_bones
    Adaptation shared, personal;
  };
  struct BoneLink {
    std::int16_t bone = 0;
    std::int16_t landmark = 0;
  };
  struct SignalGain {
    std::uint16_t signal = 0;
    float gain = 0;
  };

  struct Mix {
    std::uint16_t signal = 0;  // of signals_
    bool shared = false;       // `expressions` gives it, too
  };

  Result<> TakeSources(const ExpressionMapping* expressions,
                       const ExpressionMapping* personal) noexcept;
  std::optional<std::size_t> FindSignal(const ShortName& name) const noexcept;
  Result<> SolveBones(Solution& solution) noexcept;
  Result<> SolveAdaptation(const Source& source, const Neutral& neutral,
                           Adaptation& adaptation) noexcept;
  void ReadExpressions(const FacePose& face) noexcept;
  void Evaluate(const Source& source, const Adaptation& adaptation, const FacePose& face,
                std::span<float> signals, std::span<float> novelty) const noexcept;
  static void Settle(const Source& source, Time captured, Steady& steady,
                     std::span<float> signals) noexcept;
  void AdvanceBlend(Time captured) noexcept;
  void ReadHead(const FacePose& face) noexcept;
  void MoveBones(const FacePose& face) noexcept;
  float ChannelValue(std::size_t channel) const noexcept;

  const Rig* rig_ = nullptr;
  Source shared_, personal_;
  InlineVector<BoneLink, kMaxBones> links_;  // bones with a landmark
  std::array<InlineVector<SignalGain, kMaxDrives>, kMaxChannels> gains_;
  std::array<Solution, 2> solutions_;
  std::size_t current_ = 0;
  bool has_neutral_ = false;
  std::span<std::byte> workspace_;

  InlineVector<ShortName, 2 * kMaxSignals> names_;  // of the expressions' signals
  InlineVector<Mix, kMaxSignals> mixes_;            // by signal of the personal profile
  float blend_ = 1;                                 // this frame
  float blend_goal_ = 1;
  std::optional<Time> blended_at_;  // the last frame's time
  std::array<float, 2 * kMaxSignals + kHeadSignals.size()> signals_{};
  std::size_t signal_count_ = 0;
  Steady shared_steady_, personal_steady_;
  std::array<float, kMaxRegions> novelty_{};
  std::array<Point3, kMaxBones> offsets_cm_{};  // of bones from their rest, this frame
};

}  // namespace facewire::retarget

#endif  // FACEWIRE_CORE_RETARGET_RETARGETER_H_
