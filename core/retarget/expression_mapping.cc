#include "core/retarget/expression_mapping.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "core/marker_name.h"

namespace facewire::retarget {
namespace {

bool IsValid(const RegionConfig& region, std::size_t markers, std::size_t signals) noexcept {
  constexpr float kMaxDeadZone = 0.25F;
  const auto is_marker = [markers](std::uint16_t i) { return i < markers; };
  const auto is_signal = [signals](std::uint16_t i) { return i < signals; };
  return region.inputs() > 0 && !region.outputs.empty() && region.axes <= region.inputs() &&
         std::isfinite(region.gap_gain) && std::ranges::all_of(region.points, is_marker) &&
         std::ranges::all_of(region.origin, is_marker) &&
         std::ranges::all_of(region.gaps,
                             [&](const RegionConfig::Gap& gap) {
                               return is_marker(gap.upper) && is_marker(gap.lower);
                             }) &&
         region.dead_zone >= 0 && region.dead_zone <= kMaxDeadZone &&
         (region.ignores.empty() || region.axes > 0) &&
         std::ranges::all_of(region.ignores, is_signal) &&
         std::ranges::all_of(region.outputs, is_signal);
}

bool IsValid(const Training& t) noexcept {
  const std::size_t samples = t.sample_count();
  if (samples == 0 || t.signals.empty() || t.samples.size() != samples * 3 * t.markers.size() ||
      t.targets.size() != samples * t.signals.size() || t.neutral_sample >= samples ||
      (!t.weights.empty() && t.weights.size() != samples) ||
      !std::ranges::all_of(t.weights, [](float w) { return std::isfinite(w) && w > 0; }))
    return false;
  std::array<int, kMaxSignals> uses{};
  for (const RegionConfig& region : t.regions) {
    if (!IsValid(region, t.markers.size(), t.signals.size())) return false;
    for (const std::uint16_t output : region.outputs) ++uses[output];
  }
  return std::ranges::all_of(std::span(uses).first(t.signals.size()),
                             [](int count) { return count == 1; });
}

}  // namespace

Result<> ExpressionMapping::Check(const Training& t) noexcept {
  if (t.markers.size() > kMaxMarkers || t.signals.size() > kMaxSignals ||
      t.regions.size() > kMaxRegions || t.sample_count() > kMaxTrainingSamples)
    return Errc::kFull;
  if (!IsValid(t)) return Errc::kInvalidArgument;
  return {};
}

std::size_t ExpressionMapping::RequiredBytes(const Training& training) noexcept {
  std::size_t bytes = 0;
  for (const RegionConfig& region : training.regions)
    bytes += Region::RequiredBytes(region, training.sample_count());
  return bytes;
}

std::size_t ExpressionMapping::WorkspaceBytes(const Training& training) noexcept {
  std::size_t bytes = 0;
  for (const RegionConfig& region : training.regions)
    bytes = std::max(bytes, Region::WorkspaceBytes(region, training.sample_count()));
  return bytes;
}

Result<> ExpressionMapping::TakeNames(const Training& t) noexcept {
  markers_.clear();
  point_indices_.clear();
  signals_.clear();
  std::size_t landmarks = 0;
  for (std::size_t i = 0; i < t.markers.size(); ++i) {
    const auto landmark = LandmarkOf(t.markers[i].view());
    if (landmark) ++landmarks;
    if (!markers_.try_push(t.markers[i]) ||
        !point_indices_.try_push(landmark.value_or(static_cast<std::int16_t>(i))))
      return Errc::kFull;
  }
  if (landmarks != 0 && landmarks != t.markers.size()) return Errc::kInvalidArgument;
  reads_landmarks_ = landmarks != 0;
  for (const ShortName& signal : t.signals)
    if (!signals_.try_push(signal)) return Errc::kFull;
  return {};
}

Result<> ExpressionMapping::Configure(const Training& t, Arena& arena,
                                      std::span<std::byte> workspace, TrainingReport& report,
                                      std::span<float> leave_one_out) noexcept {
  report = {};
  if (auto checked = Check(t); !checked) return checked;
  if (!leave_one_out.empty() && leave_one_out.size() != t.targets.size())
    return Errc::kInvalidArgument;
  if (auto taken = TakeNames(t); !taken) return taken;
  average_user_ = t.average_user;

  neutral_.clear();
  const std::size_t columns = t.markers.size();
  const auto neutral = t.samples.subspan(t.neutral_sample * 3 * columns, 3 * columns);
  for (std::size_t i = 0; i < columns; ++i)
    if (!neutral_.try_push({neutral[3 * i], neutral[3 * i + 1], neutral[3 * i + 2]}))
      return Errc::kFull;
  if (!regions_.try_resize(t.regions.size()) || !ranges_.try_resize(t.signals.size()))
    return Errc::kFull;
  for (std::size_t r = 0; r < t.regions.size(); ++r) {
    report.region = r;
    if (auto fitted =
            regions_[r].Configure(t.regions[r], t, arena, workspace, report, leave_one_out);
        !fitted)
      return fitted;
    for (std::size_t o = 0; o < t.regions[r].outputs.size(); ++o) {
      const SoftRange& range = regions_[r].range(o);
      ranges_[t.regions[r].outputs[o]] = range.high - range.low;
    }
  }
  return {};
}

void ExpressionMapping::Evaluate(std::span<const Point3> points_cm, std::span<float> signals,
                                 std::span<float> novelty) const noexcept {
  std::array<float, kMaxSignals> outputs{};
  for (std::size_t r = 0; r < regions_.size(); ++r) {
    const std::span<const std::uint16_t> at = regions_[r].config().outputs.span();
    const float found = regions_[r].Evaluate(points_cm, std::span(outputs).first(at.size()));
    for (std::size_t o = 0; o < at.size(); ++o) signals[at[o]] = outputs[o];
    if (!novelty.empty()) novelty[r] = found;
  }
}

}  // namespace facewire::retarget
