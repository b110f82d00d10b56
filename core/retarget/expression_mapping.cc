#include "core/retarget/expression_mapping.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/marker_name.h"
#include "core/rbf/principal_axes.h"

namespace facewire::retarget {
namespace {

constexpr std::size_t kMaxInputs = kMaxExpressionInputs + kMaxRegionGaps;

std::size_t Dimensions(const RegionConfig& region) noexcept {
  return region.axes > 0 ? region.axes : region.inputs();
}

rbf::RbfShape ShapeOf(const RegionConfig& region, std::size_t samples) noexcept {
  return {samples, Dimensions(region), region.outputs.size(), region.rbf.tail};
}

bool IsValid(const RegionConfig& region, std::size_t markers, std::size_t signals) noexcept {
  const auto is_marker = [markers](std::uint16_t i) { return i < markers; };
  return region.inputs() > 0 && !region.outputs.empty() && region.axes <= region.inputs() &&
         std::isfinite(region.gap_gain) && std::ranges::all_of(region.points, is_marker) &&
         std::ranges::all_of(region.origin, is_marker) &&
         std::ranges::all_of(region.gaps,
                             [&](const RegionConfig::Gap& gap) {
                               return is_marker(gap.upper) && is_marker(gap.lower);
                             }) &&
         std::ranges::all_of(region.outputs, [signals](std::uint16_t i) { return i < signals; });
}

bool IsValid(const Training& t) noexcept {
  const std::size_t samples = t.sample_count();
  if (samples == 0 || t.signals.empty() || t.samples.size() != samples * 3 * t.markers.size() ||
      t.targets.size() != samples * t.signals.size() || t.neutral_sample >= samples)
    return false;
  std::array<int, kMaxSignals> uses{};
  for (const RegionConfig& region : t.regions) {
    if (!IsValid(region, t.markers.size(), t.signals.size())) return false;
    for (const std::uint16_t output : region.outputs) ++uses[output];
  }
  return std::ranges::all_of(std::span(uses).first(t.signals.size()),
                             [](int count) { return count == 1; });
}

// y = basis * x
void Project(std::span<const float> basis, std::span<const float> x, std::span<float> y) noexcept {
  for (std::size_t a = 0; a < y.size(); ++a) {
    // Four sums at a time: one long chain of additions would wait for itself.
    const float* row = basis.data() + a * x.size();
    std::array<float, 4> sum{};
    std::size_t i = 0;
    for (; i + 4 <= x.size(); i += 4)
      for (std::size_t lane = 0; lane < 4; ++lane) sum[lane] += row[i + lane] * x[i + lane];
    for (; i < x.size(); ++i) sum[0] += row[i] * x[i];
    y[a] = (sum[0] + sum[1]) + (sum[2] + sum[3]);
  }
}

std::size_t RegionWorkspaceBytes(const RegionConfig& region, std::size_t samples) noexcept {
  const std::size_t inputs = region.inputs();
  const std::size_t floats = samples * (inputs + Dimensions(region) + 2 * region.outputs.size());
  return floats * sizeof(float) + 64 +
         std::max(rbf::Rbf::WorkspaceBytes(ShapeOf(region, samples)),
                  rbf::PrincipalAxesWorkspaceBytes(inputs, region.axes));
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
    bytes += rbf::Rbf::RequiredBytes(ShapeOf(region, training.sample_count())) +
             (region.axes * region.inputs() + 1) * sizeof(float);
  return bytes;
}

std::size_t ExpressionMapping::WorkspaceBytes(const Training& training) noexcept {
  std::size_t bytes = 0;
  for (const RegionConfig& region : training.regions)
    bytes = std::max(bytes, RegionWorkspaceBytes(region, training.sample_count()));
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
  ranges_.clear();
  for (std::size_t o = 0; o < t.signals.size(); ++o) {
    Range range;
    range.neutral = range.low = range.high = t.targets[t.neutral_sample * t.signals.size() + o];
    for (std::size_t s = 0; s < t.sample_count(); ++s) {
      range.low = std::min(range.low, t.targets[s * t.signals.size() + o]);
      range.high = std::max(range.high, t.targets[s * t.signals.size() + o]);
    }
    if (!ranges_.try_push(range)) return Errc::kFull;
  }
  if (!regions_.try_resize(t.regions.size())) return Errc::kFull;
  for (std::size_t r = 0; r < t.regions.size(); ++r) {
    report.region = r;
    regions_[r].config = t.regions[r];
    if (auto fitted = FitRegion(regions_[r], t, arena, workspace, report.fit, leave_one_out);
        !fitted)
      return fitted;
  }
  return {};
}

Result<> ExpressionMapping::FitRegion(Region& region, const Training& t, Arena& arena,
                                      std::span<std::byte> workspace, rbf::FitReport& report,
                                      std::span<float> leave_one_out) noexcept {
  const RegionConfig& config = region.config;
  const std::size_t samples = t.sample_count();
  const std::size_t inputs = config.inputs();
  const std::size_t outputs = config.outputs.size();
  const rbf::RbfShape shape = ShapeOf(config, samples);
  Arena scratch(workspace);
  const auto all = scratch.MakeArray<float>(samples * inputs);
  const auto projected = scratch.MakeArray<float>(samples * shape.inputs);
  const auto targets = scratch.MakeArray<float>(samples * outputs);
  const auto errors = scratch.MakeArray<float>(samples * outputs);
  if (all.empty() || projected.empty() || targets.empty() || errors.empty()) return Errc::kFull;
  const auto rest = workspace.subspan(scratch.used());

  std::array<Point3, kMaxMarkers> points{};
  for (std::size_t s = 0; s < samples; ++s) {
    for (std::size_t i = 0; i < t.markers.size(); ++i) {
      const auto xyz = t.samples.subspan((s * t.markers.size() + i) * 3, 3);
      points[i] = {xyz[0], xyz[1], xyz[2]};
    }
    ReadInputs(config, std::span(points).first(t.markers.size()), all.subspan(s * inputs, inputs));
    for (std::size_t o = 0; o < outputs; ++o)
      targets[s * outputs + o] = t.targets[s * t.signals.size() + config.outputs[o]];
  }
  if (config.axes > 0) {
    region.basis = arena.MakeArray<float>(config.axes * inputs);
    if (region.basis.empty()) return Errc::kFull;
    if (auto found = rbf::PrincipalAxes(all, inputs, config.axes, region.basis, rest); !found)
      return found;
    for (std::size_t s = 0; s < samples; ++s)
      Project(region.basis, all.subspan(s * inputs, inputs),
              projected.subspan(s * shape.inputs, shape.inputs));
  } else {
    region.basis = {};
    std::ranges::copy(all, projected.begin());
  }
  if (auto reserved = region.rbf.Reserve(shape, arena); !reserved) return reserved;
  if (auto fitted = region.rbf.Fit(config.rbf, shape, projected, targets, rest, report,
                                   leave_one_out.empty() ? std::span<float>{} : errors);
      !fitted)
    return fitted;
  for (std::size_t s = 0; !leave_one_out.empty() && s < samples; ++s)
    for (std::size_t o = 0; o < outputs; ++o)
      leave_one_out[s * t.signals.size() + config.outputs[o]] = errors[s * outputs + o];
  return {};
}

void ExpressionMapping::ReadInputs(const RegionConfig& region, std::span<const Point3> points_cm,
                                   std::span<float> inputs) const noexcept {
  Point3 origin;
  for (const std::uint16_t i : region.origin) origin = origin + points_cm[i];
  if (!region.origin.empty()) origin = (1.0F / static_cast<float>(region.origin.size())) * origin;
  std::size_t at = 0;
  for (const std::uint16_t i : region.points) {
    const Point3 p = points_cm[i] - origin;
    inputs[at++] = p.x;
    inputs[at++] = p.y;
    inputs[at++] = p.z;
  }
  for (const RegionConfig::Gap& gap : region.gaps) {
    inputs[at++] = region.gap_gain * (points_cm[gap.upper].y - points_cm[gap.lower].y);
  }
}

void ExpressionMapping::Evaluate(std::span<const Point3> points_cm,
                                 std::span<float> signals) const noexcept {
  std::array<float, kMaxInputs> inputs{};
  std::array<float, kMaxInputs> projected{};
  std::array<float, kMaxSignals> outputs{};
  for (const Region& region : regions_) {
    const RegionConfig& config = region.config;
    std::span<float> x = std::span(inputs).first(config.inputs());
    ReadInputs(config, points_cm, x);
    if (config.axes > 0) {
      const std::span<float> on_axes = std::span(projected).first(config.axes);
      Project(region.basis, x, on_axes);
      x = on_axes;
    }
    region.rbf.Evaluate(x, std::span(outputs).first(config.outputs.size()));
    for (std::size_t o = 0; o < config.outputs.size(); ++o) {
      const std::uint16_t signal = config.outputs[o];
      const Range& range = ranges_[signal];
      signals[signal] =
          std::isfinite(outputs[o]) ? std::clamp(outputs[o], range.low, range.high) : range.neutral;
    }
  }
}

}  // namespace facewire::retarget
