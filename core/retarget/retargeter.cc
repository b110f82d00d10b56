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

std::optional<std::size_t> FindSignal(const ExpressionMapping* expressions,
                                      const ShortName& name) noexcept {
  std::size_t count = 0;
  if (expressions != nullptr) {
    const auto names = expressions->signals();
    const auto found = std::ranges::find(names, name);
    if (found != names.end()) return static_cast<std::size_t>(found - names.begin());
    count = names.size();
  }
  const auto* const head = std::ranges::find(kHeadSignals, name.view());
  if (head == kHeadSignals.end()) return std::nullopt;
  return count + static_cast<std::size_t>(head - kHeadSignals.begin());
}

}  // namespace

std::optional<ShortName> FirstUnknownSignal(const Rig& rig,
                                            const ExpressionMapping* expressions) noexcept {
  for (const Channel& channel : rig.channels)
    for (const Drive& drive : channel.drives)
      if (!FindSignal(expressions, drive.signal)) return drive.signal;
  return std::nullopt;
}

std::size_t Retargeter::RequiredBytes() noexcept {
  return 2 * (GeometryMapping::RequiredBytes(kMaxBones) +
              GeometryMapping::RequiredBytes(kMaxMarkers)) +
         GeometryMapping::WorkspaceBytes(kMaxMarkers) + alignof(std::max_align_t);
}

Result<> Retargeter::Configure(const Rig& rig, const ExpressionMapping* expressions,
                               Arena& arena) noexcept {
  if (FirstUnknownSignal(rig, expressions)) return Errc::kNotFound;
  for (Solution& solution : solutions_) {
    if (auto r = solution.to_bones.Reserve(kMaxBones, arena); !r) return r;
    if (auto r = solution.to_average.Reserve(kMaxMarkers, arena); !r) return r;
  }
  const std::size_t bytes = GeometryMapping::WorkspaceBytes(kMaxMarkers);
  void* at = arena.Allocate(bytes, alignof(std::max_align_t));
  if (at == nullptr) return Errc::kFull;
  workspace_ = {static_cast<std::byte*>(at), bytes};

  rig_ = &rig;
  expressions_ = expressions;
  has_neutral_ = false;
  signals_.fill(0);
  signal_count_ =
      (expressions == nullptr ? 0 : expressions->signals().size()) + kHeadSignals.size();
  links_.clear();
  for (std::size_t b = 0; b < rig.bones.size(); ++b) {
    const std::int16_t landmark = rig.bones[b].landmark;
    if (landmark < 0 || landmark >= static_cast<std::int16_t>(kMaxLandmarks)) continue;
    if (!links_.try_push({static_cast<std::int16_t>(b), landmark})) return Errc::kFull;
  }
  for (std::size_t c = 0; c < rig.channels.size(); ++c) {
    gains_[c].clear();
    for (const Drive& drive : rig.channels[c].drives) {
      const auto signal = FindSignal(expressions, drive.signal);
      if (!signal || !gains_[c].try_push({static_cast<std::uint16_t>(*signal), drive.gain}))
        return Errc::kNotFound;
    }
  }
  return {};
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
  if (auto solved = SolveAverage(next); !solved) return solved;
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
    landmarks[n++] = link.landmark;
  }
  solution.bones_at_neutral.clear();
  if (n == 0) return {};
  if (auto solved = solution.to_bones.Solve(std::span(source).first(n), std::span(target).first(n),
                                            std::span(landmarks).first(n), workspace_);
      !solved)
    return solved;
  for (const BoneLink& link : links_) {
    const bool seen = static_cast<std::size_t>(link.landmark) < solution.neutral.count;
    const Point3 at =
        seen ? solution.to_bones.Map(solution.neutral.points_cm[link.landmark]) : Point3{};
    if (!solution.bones_at_neutral.try_push(at)) return Errc::kFull;
  }
  return {};
}

Result<> Retargeter::SolveAverage(Solution& solution) noexcept {
  solution.markers_at_neutral.clear();
  if (expressions_ == nullptr || !expressions_->average_user()) return {};
  const auto indices = expressions_->point_indices();
  const auto average = expressions_->neutral_cm();
  std::array<Point3, kMaxMarkers> source{};
  std::array<Point3, kMaxMarkers> target{};
  std::array<std::int16_t, kMaxMarkers> landmarks{};
  std::size_t n = 0;
  for (std::size_t i = 0; i < indices.size(); ++i) {
    if (static_cast<std::size_t>(indices[i]) >= solution.neutral.count) continue;
    source[n] = solution.neutral.points_cm[indices[i]];
    target[n] = average[i];
    landmarks[n++] = expressions_->reads_landmarks() ? indices[i] : std::int16_t{-1};
  }
  if (n == 0) return Errc::kInvalidArgument;
  if (auto solved =
          solution.to_average.Solve(std::span(source).first(n), std::span(target).first(n),
                                    std::span(landmarks).first(n), workspace_);
      !solved)
    return solved;
  for (const std::int16_t index : indices) {
    const bool seen = static_cast<std::size_t>(index) < solution.neutral.count;
    const Point3 at = seen ? solution.to_average.Map(solution.neutral.points_cm[index]) : Point3{};
    if (!solution.markers_at_neutral.try_push(at)) return Errc::kFull;
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
  if (expressions_ == nullptr) return;
  const Solution& solution = solutions_[current_];
  const bool mapped = expressions_->average_user();
  const auto indices = expressions_->point_indices();
  const auto average = expressions_->neutral_cm();
  std::array<Point3, kMaxMarkers> points{};
  for (std::size_t i = 0; i < indices.size(); ++i) {
    const auto index = static_cast<std::size_t>(indices[i]);
    const bool seen = index < face.count && (!has_neutral_ || index < solution.neutral.count);
    if (!seen) {
      points[i] = average[i];
    } else if (!has_neutral_) {
      points[i] = face.points_cm[index];
    } else if (mapped) {
      points[i] = average[i] +
                  (solution.to_average.Map(face.points_cm[index]) - solution.markers_at_neutral[i]);
    } else {
      points[i] = average[i] + (face.points_cm[index] - solution.neutral.points_cm[index]);
    }
  }
  expressions_->Evaluate(std::span(points).first(indices.size()),
                         std::span(signals_).first(expressions_->signals().size()),
                         std::span(novelty_).first(expressions_->region_count()));
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
  if (!has_neutral_ || solution.bones_at_neutral.empty()) return;
  const std::size_t seen = std::min(face.count, solution.neutral.count);
  for (std::size_t i = 0; i < links_.size(); ++i) {
    const BoneLink& link = links_[i];
    if (static_cast<std::size_t>(link.landmark) >= seen) continue;
    const Point3 offset =
        solution.to_bones.Map(face.points_cm[link.landmark]) - solution.bones_at_neutral[i];
    if (IsFinite(offset)) offsets_cm_[link.bone] = offset;
  }
}

float Retargeter::ChannelValue(std::size_t index) const noexcept {
  const Channel& channel = rig_->channels[index];
  if (channel.drives.empty() && IsPosition(channel.kind)) {
    if (channel.bone < 0) return channel.neutral;
    const Point3 offset = offsets_cm_[channel.bone];
    return channel.neutral + (channel.kind == ChannelKind::kPositionX   ? offset.x
                              : channel.kind == ChannelKind::kPositionY ? offset.y
                                                                        : offset.z);
  }
  float value = channel.neutral;
  for (const SignalGain& drive : gains_[index]) value += drive.gain * signals_[drive.signal];
  return std::isfinite(value) ? value : channel.neutral;
}

std::string_view Retargeter::signal_name(std::size_t index) const noexcept {
  const std::size_t expressions = signal_count_ - kHeadSignals.size();
  return index < expressions ? expressions_->signals()[index].view()
                             : kHeadSignals[index - expressions];
}

}  // namespace facewire::retarget
