#include "core/retarget/region.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/rbf/principal_axes.h"

namespace facewire::retarget {
namespace {

constexpr std::size_t kMaxInputs = kMaxExpressionInputs + kMaxRegionGaps;

SoftRange RangeOf(const Training& t, std::size_t signal, float dead_zone) noexcept {
  const auto target = [&](std::size_t sample) {
    return t.targets[sample * t.signals.size() + signal];
  };
  const float neutral = target(t.neutral_sample);
  SoftRange range{neutral, neutral, neutral, dead_zone};
  for (std::size_t s = 0; s < t.sample_count(); ++s) {
    range.low = std::min(range.low, target(s));
    range.high = std::max(range.high, target(s));
  }
  return range;
}

rbf::RbfShape RbfShapeOf(const RegionConfig& config, std::size_t samples) noexcept {
  return {samples, config.dimensions(), config.outputs.size(), config.rbf.tail};
}

nnls::NnlsShape NnlsShapeOf(const RegionConfig& config, std::size_t samples) noexcept {
  return {samples, config.dimensions(), config.outputs.size()};
}

// Whether the sample differs from the neutral one in the signals to be ignored, and in no others.
bool ShowsOnly(const RegionConfig& config, const Training& t, std::size_t sample) noexcept {
  bool shows = false;
  for (std::size_t o = 0; o < t.signals.size(); ++o) {
    if (t.targets[sample * t.signals.size() + o] ==
        t.targets[t.neutral_sample * t.signals.size() + o])
      continue;
    if (std::ranges::find(config.ignores, o) == config.ignores.end()) return false;
    shows = true;
  }
  return shows;
}

void Normalise(std::span<float> v) noexcept {
  float squares = 0;
  for (const float x : v) squares += x * x;
  const float scale = squares > 0 ? 1 / std::sqrt(squares) : 0;
  for (float& x : v) x *= scale;
}

// `inputs`: samples x direction.size() by rows. The main direction in which they go, from the
// neutral sample, where only the ignored signals show; length 1, found by power iteration. Zero
// where no sample shows only them.
void FindIgnored(const RegionConfig& config, const Training& t, std::span<const float> inputs,
                 std::span<float> direction) noexcept {
  constexpr int kRounds = 50;
  const std::size_t n = direction.size();
  const auto row = [&](std::size_t sample) { return inputs.subspan(sample * n, n); };
  const std::span<const float> neutral = row(t.neutral_sample);
  std::array<float, kMaxInputs> next{};
  std::ranges::fill(direction, 0.0F);
  for (std::size_t s = 0; s < t.sample_count(); ++s) {
    if (!ShowsOnly(config, t, s)) continue;
    for (std::size_t i = 0; i < n; ++i) direction[i] += row(s)[i] - neutral[i];
  }
  Normalise(direction);
  for (int round = 0; round < kRounds; ++round) {
    next.fill(0);
    for (std::size_t s = 0; s < t.sample_count(); ++s) {
      if (!ShowsOnly(config, t, s)) continue;
      float way = 0;
      for (std::size_t i = 0; i < n; ++i) way += direction[i] * (row(s)[i] - neutral[i]);
      for (std::size_t i = 0; i < n; ++i) next[i] += way * (row(s)[i] - neutral[i]);
    }
    Normalise(std::span(next).first(n));
    std::ranges::copy(std::span(next).first(n), direction.begin());
  }
}

// Takes a direction out of every row.
void TakeOut(std::span<const float> direction, std::span<float> rows) noexcept {
  const std::size_t n = direction.size();
  for (std::size_t at = 0; at < rows.size(); at += n) {
    float way = 0;
    for (std::size_t i = 0; i < n; ++i) way += direction[i] * rows[at + i];
    for (std::size_t i = 0; i < n; ++i) rows[at + i] -= way * direction[i];
  }
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

}  // namespace

std::size_t Region::RequiredBytes(const RegionConfig& config, std::size_t samples) noexcept {
  const std::size_t floats = config.axes * config.inputs() + samples + 2;
  return floats * sizeof(float) + TrainedSpace::RequiredBytes(NnlsShapeOf(config, samples)) +
         (config.method == Method::kRbf ? rbf::Rbf::RequiredBytes(RbfShapeOf(config, samples))
                                        : nnls::Nnls::RequiredBytes(NnlsShapeOf(config, samples)));
}

std::size_t Region::WorkspaceBytes(const RegionConfig& config, std::size_t samples) noexcept {
  const std::size_t floats =
      samples * (config.inputs() + config.dimensions() + 2 * config.outputs.size());
  const std::size_t function = config.method == Method::kRbf
                                   ? rbf::Rbf::WorkspaceBytes(RbfShapeOf(config, samples))
                                   : nnls::Nnls::WorkspaceBytes(NnlsShapeOf(config, samples));
  return floats * sizeof(float) + alignof(std::max_align_t) +
         std::max({function, rbf::PrincipalAxesWorkspaceBytes(config.inputs(), config.axes),
                   TrainedSpace::WorkspaceBytes(NnlsShapeOf(config, samples))});
}

Result<> Region::Configure(const RegionConfig& config, const Training& t, Arena& arena,
                           std::span<std::byte> workspace, TrainingReport& report,
                           std::span<float> leave_one_out) noexcept {
  config_ = config;
  ranges_.clear();
  for (const std::uint16_t output : config_.outputs)
    if (!ranges_.try_push(RangeOf(t, output, config_.dead_zone))) return Errc::kFull;
  const std::size_t samples = t.sample_count();
  const std::size_t inputs = config_.inputs();
  const std::size_t dimensions = config_.dimensions();
  const std::size_t outputs = config_.outputs.size();
  Arena scratch(workspace);
  const auto all = scratch.MakeArray<float>(samples * inputs);
  const auto projected = scratch.MakeArray<float>(samples * dimensions);
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
    ReadInputs(std::span(points).first(t.markers.size()), all.subspan(s * inputs, inputs));
    for (std::size_t o = 0; o < outputs; ++o)
      targets[s * outputs + o] = t.targets[s * t.signals.size() + config_.outputs[o]];
  }
  std::array<float, kMaxInputs> ignored{};
  const std::span<float> direction = std::span(ignored).first(inputs);
  if (!config_.ignores.empty()) {
    FindIgnored(config_, t, all, direction);
    TakeOut(direction, all);
  }
  if (config_.axes > 0) {
    basis_ = arena.MakeArray<float>(dimensions * inputs);
    if (basis_.empty()) return Errc::kFull;
    if (auto found = rbf::PrincipalAxes(all, inputs, dimensions, basis_, rest); !found)
      return found;
    TakeOut(direction, basis_);  // so that it is not seen in a face either
    for (std::size_t s = 0; s < samples; ++s)
      Project(basis_, all.subspan(s * inputs, inputs),
              projected.subspan(s * dimensions, dimensions));
  } else {
    basis_ = {};
    std::ranges::copy(all, projected.begin());
  }
  if (auto fitted = Fit(projected, targets, t, arena, rest, report,
                        leave_one_out.empty() ? std::span<float>{} : errors);
      !fitted)
    return fitted;
  if (auto known = space_.Configure(NnlsShapeOf(config_, samples), projected, targets,
                                    t.neutral_sample, arena, rest);
      !known)
    return known;
  std::array<float, kMaxSignals> outputs_there{};
  for (std::size_t s = 0; s < samples; ++s) {
    const auto x = projected.subspan(s * dimensions, dimensions);
    EvaluateAt(x, std::span(outputs_there).first(outputs));
    space_.Calibrate(x, std::span(outputs_there).first(outputs));
  }
  for (std::size_t s = 0; !leave_one_out.empty() && s < samples; ++s)
    for (std::size_t o = 0; o < outputs; ++o)
      leave_one_out[s * t.signals.size() + config_.outputs[o]] = errors[s * outputs + o];
  return {};
}

Result<> Region::Fit(std::span<const float> inputs, std::span<const float> targets,
                     const Training& t, Arena& arena, std::span<std::byte> workspace,
                     TrainingReport& report, std::span<float> leave_one_out) noexcept {
  const std::size_t samples = t.sample_count();
  distances_ = {};
  if (config_.method == Method::kNnls) {
    const nnls::NnlsShape shape = NnlsShapeOf(config_, samples);
    if (auto reserved = nnls_.Reserve(shape, arena); !reserved) return reserved;
    return nnls_.Fit(config_.nnls, shape, inputs, targets, t.neutral_sample, workspace, report.nnls,
                     leave_one_out);
  }
  const rbf::RbfShape shape = RbfShapeOf(config_, samples);
  distances_ = arena.MakeArray<float>(samples);
  if (distances_.empty()) return Errc::kFull;
  if (auto reserved = rbf_.Reserve(shape, arena); !reserved) return reserved;
  return rbf_.Fit(config_.rbf, shape, inputs, targets, workspace, report.fit, leave_one_out,
                  t.weights);
}

void Region::ReadInputs(std::span<const Point3> points_cm, std::span<float> inputs) const noexcept {
  Point3 origin;
  for (const std::uint16_t i : config_.origin) origin = origin + points_cm[i];
  if (!config_.origin.empty()) origin = (1.0F / static_cast<float>(config_.origin.size())) * origin;
  std::size_t at = 0;
  for (const std::uint16_t i : config_.points) {
    const Point3 p = points_cm[i] - origin;
    inputs[at++] = p.x;
    inputs[at++] = p.y;
    inputs[at++] = p.z;
  }
  for (const RegionConfig::Gap& gap : config_.gaps) {
    inputs[at++] = config_.gap_gain * (points_cm[gap.upper].y - points_cm[gap.lower].y);
  }
}

float Region::Evaluate(std::span<const Point3> points_cm, std::span<float> outputs) const noexcept {
  std::array<float, kMaxInputs> inputs{};
  std::array<float, kMaxInputs> projected{};
  std::span<float> x = std::span(inputs).first(config_.inputs());
  ReadInputs(points_cm, x);
  if (config_.axes > 0) {
    const std::span<float> on_axes = std::span(projected).first(config_.axes);
    Project(basis_, x, on_axes);
    x = on_axes;
  }
  EvaluateAt(x, outputs);
  const float novelty = space_.Novelty(x, outputs, distances_);
  // Least squares within their bounds do not extrapolate.
  if (config_.method == Method::kRbf) space_.Ease(novelty, distances_, outputs);
  return novelty;
}

void Region::EvaluateAt(std::span<const float> x, std::span<float> outputs) const noexcept {
  if (config_.method == Method::kNnls) {
    nnls_.Evaluate(x, outputs);
  } else {
    rbf_.Evaluate(x, outputs, distances_);
  }
  for (std::size_t o = 0; o < outputs.size(); ++o) outputs[o] = ranges_[o].Limit(outputs[o]);
}

}  // namespace facewire::retarget
