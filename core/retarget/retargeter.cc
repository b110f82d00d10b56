#include "core/retarget/retargeter.h"

#include <algorithm>
#include <cmath>

namespace facewire::retarget {
namespace {

bool IsFinite(Point3 p) noexcept {
  return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}

Matrix3 TransposeTimes(const Matrix3& a, const Matrix3& b) noexcept {
  Matrix3 out{};
  for (std::size_t row = 0; row < 3; ++row)
    for (std::size_t c = 0; c < 3; ++c)
      for (std::size_t k = 0; k < 3; ++k) out[3 * row + c] += a[3 * k + row] * b[3 * k + c];
  return out;
}

Point3 TransposeTimes(const Matrix3& a, Point3 p) noexcept {
  return {a[0] * p.x + a[3] * p.y + a[6] * p.z, a[1] * p.x + a[4] * p.y + a[7] * p.z,
          a[2] * p.x + a[5] * p.y + a[8] * p.z};
}

bool Gives(const ExpressionMapping* mapping, const ShortName& signal) noexcept {
  return mapping != nullptr &&
         std::ranges::find(mapping->signals(), signal) != mapping->signals().end();
}

bool Gives(std::span<const std::string_view> head, const ShortName& signal) noexcept {
  return std::ranges::find(head, signal.view()) != head.end();
}

}  // namespace

std::optional<ShortName> FirstUnknownSignal(const Rig& rig, const ExpressionMapping* expressions,
                                            const ExpressionMapping* personal) noexcept {
  for (const Channel& channel : rig.channels)
    for (const Drive& drive : channel.drives)
      if (!Gives(expressions, drive.signal) && !Gives(personal, drive.signal) &&
          !Gives(kHeadSignals, drive.signal))
        return drive.signal;
  return std::nullopt;
}

std::size_t Retargeter::RequiredBytes() noexcept {
  return 2 * (GeometryMapping::RequiredBytes(kMaxBones) +
              2 * GeometryMapping::RequiredBytes(kMaxMarkers)) +
         GeometryMapping::WorkspaceBytes(kMaxMarkers) + alignof(std::max_align_t);
}

Result<> Retargeter::Configure(const Rig& rig, const ExpressionMapping* expressions, Arena& arena,
                               const ExpressionMapping* personal) noexcept {
  if (FirstUnknownSignal(rig, expressions, personal)) return Errc::kNotFound;
  for (Solution& solution : solutions_) {
    if (auto r = solution.to_bones.Reserve(kMaxBones, arena); !r) return r;
    if (auto r = solution.shared.to_profile.Reserve(kMaxMarkers, arena); !r) return r;
    if (auto r = solution.personal.to_profile.Reserve(kMaxMarkers, arena); !r) return r;
  }
  const std::size_t bytes = GeometryMapping::WorkspaceBytes(kMaxMarkers);
  void* at = arena.Allocate(bytes, alignof(std::max_align_t));
  if (at == nullptr) return Errc::kFull;
  workspace_ = {static_cast<std::byte*>(at), bytes};

  if (auto taken = TakeSources(expressions, personal); !taken) return taken;
  rig_ = &rig;
  has_neutral_ = false;
  blend_ = blend_goal_ = 1;
  blended_at_.reset();
  shared_steady_.Reset();
  personal_steady_.Reset();
  signals_.fill(0);
  signal_count_ = names_.size() + kHeadSignals.size();
  links_.clear();
  for (std::size_t b = 0; b < rig.bones.size(); ++b) {
    const std::int16_t landmark = rig.bones[b].landmark;
    if (landmark < 0 || landmark >= static_cast<std::int16_t>(kMaxLandmarks)) continue;
    if (!links_.try_push({static_cast<std::int16_t>(b), landmark})) return Errc::kFull;
  }
  for (std::size_t c = 0; c < rig.channels.size(); ++c) {
    gains_[c].clear();
    for (const Drive& drive : rig.channels[c].drives) {
      const auto signal = FindSignal(drive.signal);
      if (!signal || !gains_[c].try_push({static_cast<std::uint16_t>(*signal), drive.gain}))
        return Errc::kNotFound;
    }
  }
  return {};
}

Result<> Retargeter::TakeSources(const ExpressionMapping* expressions,
                                 const ExpressionMapping* personal) noexcept {
  shared_ = {expressions, expressions != nullptr && expressions->average_user(), {}};
  // The performer of today is not quite the one of the recording: another day, another camera.
  personal_ = {personal, true, {}};
  names_.clear();
  mixes_.clear();
  if (expressions != nullptr) {
    for (const std::int16_t point : expressions->point_indices())
      if (!shared_.points.try_push(point)) return Errc::kFull;
    for (const ShortName& signal : expressions->signals())
      if (!names_.try_push(signal)) return Errc::kFull;
  }
  if (personal == nullptr) return {};
  if (expressions != nullptr && expressions->reads_landmarks() != personal->reads_landmarks())
    return Errc::kUnsupported;
  for (std::size_t i = 0; i < personal->markers().size(); ++i) {
    std::int16_t point = personal->point_indices()[i];
    if (expressions != nullptr && !expressions->reads_landmarks()) {
      const auto found = std::ranges::find(expressions->markers(), personal->markers()[i]);
      if (found == expressions->markers().end()) return Errc::kUnsupported;
      point = expressions->point_indices()[found - expressions->markers().begin()];
    }
    if (!personal_.points.try_push(point)) return Errc::kFull;
  }
  for (const ShortName& signal : personal->signals()) {
    const bool shared = Gives(expressions, signal);
    if (!shared && !names_.try_push(signal)) return Errc::kFull;
    const auto index = static_cast<std::size_t>(std::ranges::find(names_, signal) - names_.begin());
    if (!mixes_.try_push({static_cast<std::uint16_t>(index), shared})) return Errc::kFull;
  }
  return {};
}

std::optional<std::size_t> Retargeter::FindSignal(const ShortName& name) const noexcept {
  for (std::size_t i = 0; i < signal_count_; ++i)
    if (signal_name(i) == name.view()) return i;
  return std::nullopt;
}

void Retargeter::SetBlend(float blend) noexcept {
  if (std::isnan(blend)) return;
  blend_goal_ = std::clamp(blend, 0.0F, 1.0F);
  if (!blended_at_) blend_ = blend_goal_;
}

Result<> Retargeter::SetNeutral(const Neutral& neutral) noexcept {
  if (rig_ == nullptr || neutral.count == 0 || neutral.count > kMaxLandmarks ||
      !std::ranges::all_of(std::span(neutral.points_cm).first(neutral.count), IsFinite) ||
      !IsFinite(neutral.camera_t_head_cm) ||
      !std::ranges::all_of(neutral.camera_R_head, [](float v) { return std::isfinite(v); }))
    return Errc::kInvalidArgument;
  Solution& next = solutions_[1 - current_];
  next.neutral = neutral;
  if (auto solved = SolveBones(next); !solved) return solved;
  if (auto solved = SolveAdaptation(shared_, neutral, next.shared); !solved) return solved;
  if (auto solved = SolveAdaptation(personal_, neutral, next.personal); !solved) return solved;
  shared_steady_.Reset();
  personal_steady_.Reset();
  current_ = 1 - current_;
  has_neutral_ = true;
  return {};
}

Result<> Retargeter::SolveBones(Solution& solution) noexcept {
  std::array<Point3, kMaxBones> source{};
  std::array<Point3, kMaxBones> target{};
  std::array<std::int16_t, kMaxBones> landmarks{};
  std::size_t n = 0;
  for (const BoneLink& link : links_) {
    if (static_cast<std::size_t>(link.landmark) >= solution.neutral.count) continue;
    source[n] = solution.neutral.points_cm[link.landmark];
    target[n] = rig_->bones[link.bone].rest_cm;
    landmarks[n++] = rig_->bones[link.bone].marker.empty() ? link.landmark : std::int16_t{-1};
  }
  solution.bone_anchors.clear();
  if (n == 0) return {};
  if (auto solved = solution.to_bones.Solve(std::span(source).first(n), std::span(target).first(n),
                                            std::span(landmarks).first(n), workspace_);
      !solved)
    return solved;
  for (const BoneLink& link : links_) {
    const bool seen = static_cast<std::size_t>(link.landmark) < solution.neutral.count;
    const auto anchor = seen ? solution.to_bones.AnchorAt(solution.neutral.points_cm[link.landmark])
                             : GeometryMapping::Anchor{};
    if (!solution.bone_anchors.try_push(anchor)) return Errc::kFull;
  }
  return {};
}

Result<> Retargeter::SolveAdaptation(const Source& from, const Neutral& neutral,
                                     Adaptation& adaptation) noexcept {
  adaptation.anchors.clear();
  if (from.mapping == nullptr || !from.adapted) return {};
  const auto profile = from.mapping->neutral_cm();
  std::array<Point3, kMaxMarkers> source{};
  std::array<Point3, kMaxMarkers> target{};
  std::array<std::int16_t, kMaxMarkers> landmarks{};
  std::size_t n = 0;
  for (std::size_t i = 0; i < from.points.size(); ++i) {
    const std::int16_t point = from.points[i];
    if (static_cast<std::size_t>(point) >= neutral.count) continue;
    source[n] = neutral.points_cm[point];
    target[n] = profile[i];
    landmarks[n++] = from.mapping->reads_landmarks() ? point : std::int16_t{-1};
  }
  if (n == 0) return Errc::kInvalidArgument;
  if (auto solved =
          adaptation.to_profile.Solve(std::span(source).first(n), std::span(target).first(n),
                                      std::span(landmarks).first(n), workspace_);
      !solved)
    return solved;
  for (const std::int16_t point : from.points) {
    const bool seen = static_cast<std::size_t>(point) < neutral.count;
    const auto anchor =
        seen ? adaptation.to_profile.AnchorAt(neutral.points_cm[point]) : GeometryMapping::Anchor{};
    if (!adaptation.anchors.try_push(anchor)) return Errc::kFull;
  }
  return {};
}

RigPose Retargeter::Update(const FacePose& face) noexcept {
  RigPose pose;
  pose.seq = face.seq;
  pose.captured = face.captured;
  if (rig_ == nullptr) return pose;
  ReadExpressions(face);
  ReadHead(face);
  MoveBones(face);
  pose.count = rig_->channels.size();
  for (std::size_t c = 0; c < pose.count; ++c) pose.values[c] = ChannelValue(c);
  return pose;
}

void Retargeter::ReadExpressions(const FacePose& face) noexcept {
  const Solution& solution = solutions_[current_];
  if (shared_.mapping != nullptr) {
    Evaluate(shared_, solution.shared, face, signals_,
             std::span(novelty_).first(shared_.mapping->region_count()));
    Settle(shared_, face.captured, shared_steady_, signals_);
  }
  if (personal_.mapping == nullptr) return;
  AdvanceBlend(face.captured);
  std::array<float, kMaxSignals> personal{};
  if (blend_ > 0) {
    Evaluate(personal_, solution.personal, face, personal, {});
    Settle(personal_, face.captured, personal_steady_, personal);
  }
  for (std::size_t i = 0; i < mixes_.size(); ++i) {
    float& signal = signals_[mixes_[i].signal];
    signal = (mixes_[i].shared ? (1 - blend_) * signal : 0) + blend_ * personal[i];
  }
}

// `signals` may be longer than the mapping's.
void Retargeter::Evaluate(const Source& source, const Adaptation& adaptation, const FacePose& face,
                          std::span<float> signals, std::span<float> novelty) const noexcept {
  const Neutral& neutral = solutions_[current_].neutral;
  const auto profile = source.mapping->neutral_cm();
  std::array<Point3, kMaxMarkers> points{};
  for (std::size_t i = 0; i < source.points.size(); ++i) {
    const auto point = static_cast<std::size_t>(source.points[i]);
    const bool seen = point < face.count && (!has_neutral_ || point < neutral.count);
    if (!seen) {
      points[i] = profile[i];
    } else if (!has_neutral_) {
      points[i] = face.points_cm[point];
    } else if (source.adapted) {
      points[i] =
          profile[i] + adaptation.to_profile.Motion(adaptation.anchors[i], face.points_cm[point]);
    } else {
      points[i] = profile[i] + (face.points_cm[point] - neutral.points_cm[point]);
    }
  }
  source.mapping->Evaluate(std::span(points).first(source.points.size()),
                           signals.first(source.mapping->signals().size()), novelty);
}

// Markers of a motion-capture system have no noise to speak of, and nothing is taken from them.
void Retargeter::Settle(const Source& source, Time captured, Steady& steady,
                        std::span<float> signals) noexcept {
  if (!source.mapping->reads_landmarks()) return;
  const auto ranges = source.mapping->ranges();
  steady.Update(captured, ranges, signals.first(ranges.size()));
}

void Retargeter::AdvanceBlend(Time captured) noexcept {
  // After a silence the ramp goes on where it was; a step back in time moves nothing.
  constexpr Duration kLongestStep = kBlendTime / 5;
  if (blended_at_) {
    const Duration step =
        std::clamp(Between(*blended_at_, captured), Duration::zero(), kLongestStep);
    const float reach = Seconds(step) / Seconds(kBlendTime);
    blend_ += std::clamp(blend_goal_ - blend_, -reach, reach);
  }
  blended_at_ = captured;
}

void Retargeter::ReadHead(const FacePose& face) noexcept {
  const Neutral& neutral = solutions_[current_].neutral;
  const Matrix3 rotation =
      has_neutral_ ? TransposeTimes(neutral.camera_R_head, face.camera_R_head) : face.camera_R_head;
  const HeadAngles angles = AnglesOf(rotation);
  const Point3 moved =
      has_neutral_
          ? TransposeTimes(neutral.camera_R_head, face.camera_t_head_cm - neutral.camera_t_head_cm)
          : Point3{};  // nobody knows yet where the head belongs
  const std::array<float, kHeadSignals.size()> values = {
      angles.pitch_deg, angles.yaw_deg, angles.roll_deg, moved.x, moved.y, moved.z};
  std::ranges::copy(values,
                    signals_.begin() + static_cast<std::ptrdiff_t>(signal_count_ - values.size()));
}

void Retargeter::MoveBones(const FacePose& face) noexcept {
  offsets_cm_.fill({});
  const Solution& solution = solutions_[current_];
  if (!has_neutral_ || solution.bone_anchors.empty()) return;
  const std::size_t seen = std::min(face.count, solution.neutral.count);
  for (std::size_t i = 0; i < links_.size(); ++i) {
    const BoneLink& link = links_[i];
    if (static_cast<std::size_t>(link.landmark) >= seen) continue;
    const Point3 offset =
        solution.to_bones.Motion(solution.bone_anchors[i], face.points_cm[link.landmark]);
    if (IsFinite(offset)) offsets_cm_[link.bone] = offset;
  }
}

float Retargeter::ChannelValue(std::size_t index) const noexcept {
  const Channel& channel = rig_->channels[index];
  float sum = 0;
  if (channel.drives.empty() && IsPosition(channel.kind)) {
    if (channel.bone < 0) return channel.neutral;
    const Point3 offset = offsets_cm_[channel.bone];
    sum = channel.kind == ChannelKind::kPositionX   ? offset.x
          : channel.kind == ChannelKind::kPositionY ? offset.y
                                                    : offset.z;
  }
  for (const SignalGain& drive : gains_[index]) sum += drive.gain * signals_[drive.signal];
  return channel.ValueOf(sum);
}

std::string_view Retargeter::signal_name(std::size_t index) const noexcept {
  return index < names_.size() ? names_[index].view() : kHeadSignals[index - names_.size()];
}

}  // namespace facewire::retarget
