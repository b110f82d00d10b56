#include "core/retarget/trained_space.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/base/capacity.h"
#include "core/rbf/lanes.h"

namespace facewire::retarget {
namespace {

// Of the squared distance of the farthest sample: where float stops telling samples apart.
constexpr float kTwins = 1e-8F;

float SquaredDistance(std::span<const float> a, std::span<const float> b) noexcept {
  rbf::Lanes sums{};
  std::size_t i = 0;
  for (; i + rbf::kLanes <= a.size(); i += rbf::kLanes) {
    const rbf::Lanes d = rbf::LoadLanes(a.data() + i) - rbf::LoadLanes(b.data() + i);
    sums += d * d;
  }
  float sum = (sums[0] + sums[1]) + (sums[2] + sums[3]);
  for (; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return sum;
}

}  // namespace

std::size_t TrainedSpace::RequiredBytes(const nnls::NnlsShape& s) noexcept {
  return (s.inputs + s.outputs * (1 + s.inputs + s.samples) + 1) * sizeof(float);
}

std::size_t TrainedSpace::WorkspaceBytes(const nnls::NnlsShape& s) noexcept {
  return nnls::Basis::WorkspaceBytes(s) + (s.samples + 1) * sizeof(float);
}

Result<> TrainedSpace::Configure(const nnls::NnlsShape& shape, std::span<const float> samples,
                                 std::span<const float> targets, std::size_t neutral, Arena& arena,
                                 std::span<std::byte> workspace) noexcept {
  shape_ = shape;
  rest_ = arena.MakeArray<float>(shape.inputs);
  rest_outputs_ = arena.MakeArray<float>(shape.outputs);
  basis_ = arena.MakeArray<float>(shape.outputs * shape.inputs);
  targets_ = arena.MakeArray<float>(shape.samples * shape.outputs);
  if (rest_.empty() || rest_outputs_.empty() || basis_.empty() || targets_.empty())
    return Errc::kFull;
  std::ranges::copy(samples.subspan(neutral * shape.inputs, shape.inputs), rest_.begin());
  std::ranges::copy(targets.subspan(neutral * shape.outputs, shape.outputs), rest_outputs_.begin());
  std::ranges::copy(targets, targets_.begin());

  Arena scratch(workspace);
  nnls::Basis basis;
  if (auto taken = basis.Take(shape, scratch); !taken) return taken;
  const auto nearest = scratch.MakeArray<float>(shape.samples);
  if (nearest.empty()) return Errc::kInvalidArgument;
  if (auto estimated = basis.Estimate(samples, targets, neutral); !estimated) return estimated;
  for (std::size_t o = 0; o < shape.outputs; ++o)
    for (std::size_t i = 0; i < shape.inputs; ++i)
      basis_[o * shape.inputs + i] = static_cast<float>(basis.motion(o)[i] / basis.unit(o));

  const auto sample = [&](std::size_t s) {
    return samples.subspan(s * shape.inputs, shape.inputs);
  };
  float farthest = 0;
  for (std::size_t s = 0; s < shape.samples; ++s)
    farthest = std::max(farthest, SquaredDistance(sample(s), sample(neutral)));
  std::ranges::fill(nearest, std::numeric_limits<float>::infinity());
  for (std::size_t a = 0; a < shape.samples; ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      const float squared = SquaredDistance(sample(a), sample(b));
      // Twins (poses that differ elsewhere on the face) say nothing of distances.
      if (squared <= kTwins * farthest) continue;
      nearest[a] = std::min(nearest[a], squared);
      nearest[b] = std::min(nearest[b], squared);
    }
  }
  std::ranges::sort(nearest);
  const bool alike = !std::isfinite(nearest.back());
  typical_ = alike ? 0 : std::sqrt(nearest[nearest.size() / 2]);
  loneliest_ = alike ? 0 : std::sqrt(nearest.back());
  most_unexplained_ = typical_;
  return {};
}

void TrainedSpace::Calibrate(std::span<const float> sample,
                             std::span<const float> outputs) noexcept {
  most_unexplained_ = std::max(most_unexplained_, Unexplained(sample, outputs));
}

float TrainedSpace::Unexplained(std::span<const float> x,
                                std::span<const float> outputs) const noexcept {
  std::array<float, kMaxExpressionInputs + kMaxRegionGaps> left{};
  for (std::size_t i = 0; i < x.size(); ++i) left[i] = x[i] - rest_[i];
  for (std::size_t o = 0; o < outputs.size(); ++o) {
    const float weight = outputs[o] - rest_outputs_[o];
    const float* motion = basis_.data() + o * x.size();
    for (std::size_t i = 0; i < x.size(); ++i) left[i] -= weight * motion[i];
  }
  float sum = 0;
  for (std::size_t i = 0; i < x.size(); ++i) sum += left[i] * left[i];
  return std::sqrt(sum);
}

float TrainedSpace::Novelty(std::span<const float> x, std::span<const float> outputs,
                            std::span<const float> squared_distances) const noexcept {
  float novelty = most_unexplained_ > 0 ? Unexplained(x, outputs) / most_unexplained_ : 0;
  if (!squared_distances.empty() && loneliest_ > 0)
    novelty =
        std::max(novelty, std::sqrt(*std::ranges::min_element(squared_distances)) / loneliest_);
  return std::isfinite(novelty) ? novelty : 0;
}

void TrainedSpace::Ease(float novelty, std::span<const float> squared_distances,
                        std::span<float> outputs) const noexcept {
  if (!(novelty > kUnfamiliar) || typical_ == 0) return;
  const float t = std::min((novelty - kUnfamiliar) / (kUnknown - kUnfamiliar), 1.0F);
  const float ease = t * t * (3 - 2 * t);
  // Samples count by how much farther than the nearest they are, so that one takes over from
  // another without a jump.
  const float nearest = *std::ranges::min_element(squared_distances);
  const float width = 2 * typical_ * typical_;
  std::array<float, kMaxSignals> sum{};
  float total = 0;
  for (std::size_t s = 0; s < squared_distances.size(); ++s) {
    const float weight = std::exp((nearest - squared_distances[s]) / width);
    if (weight < 1e-6F) continue;
    total += weight;
    for (std::size_t o = 0; o < outputs.size(); ++o)
      sum[o] += weight * targets_[s * outputs.size() + o];
  }
  for (std::size_t o = 0; o < outputs.size(); ++o)
    outputs[o] += ease * (sum[o] / total - outputs[o]);
}

}  // namespace facewire::retarget
