#include "core/rbf/rbf.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>

#include "core/rbf/lanes.h"
#include "core/rbf/system.h"

namespace facewire::rbf {
namespace {

constexpr std::size_t kAlignment = 64;  // a cache line

constexpr std::size_t Padded(std::size_t n) noexcept { return (n + kBlock - 1) / kBlock * kBlock; }

constexpr std::size_t Stride(const RbfShape& shape) noexcept {
  return Padded(shape.samples) + Padded(shape.tail_size());
}

std::span<float> MakeFloats(Arena& arena, std::size_t count) noexcept {
  void* at = arena.Allocate(count * sizeof(float), kAlignment);
  if (at == nullptr) return {};
  auto* first = static_cast<float*>(at);
  std::uninitialized_value_construct_n(first, count);
  return {first, count};
}

// Squared distances in units of 1 / epsilon, replaced by phi.
void ApplyKernel(Kernel kernel, float* __restrict v, std::size_t n) noexcept {
  switch (kernel) {
    case Kernel::kMultiquadric:
      for (std::size_t i = 0; i < n; ++i) v[i] = std::sqrt(1.0F + v[i]);
      return;
    case Kernel::kInverseMultiquadric:
      for (std::size_t i = 0; i < n; ++i) v[i] = 1.0F / std::sqrt(1.0F + v[i]);
      return;
    case Kernel::kGaussian:
      for (std::size_t i = 0; i < n; ++i) v[i] = std::exp(-v[i]);
      return;
    case Kernel::kLinear:
      for (std::size_t i = 0; i < n; ++i) v[i] = std::sqrt(v[i]);
      return;
    case Kernel::kCubic:
      for (std::size_t i = 0; i < n; ++i) v[i] *= std::sqrt(v[i]);
      return;
    case Kernel::kThinPlate:
      // The least float instead of 0, whose logarithm would make 0 * -inf.
      for (std::size_t i = 0; i < n; ++i)
        v[i] *= 0.5F * std::log(std::max(v[i], std::numeric_limits<float>::min()));
      return;
  }
}

// See Fit.
double BestEpsilon(const RbfConfig& config, double middle, System& system) noexcept {
  double least = std::numeric_limits<double>::infinity();
  double best = 0;  // exponent of two
  const auto attempt = [&](double exponent) noexcept {
    FitReport ignored;
    if (!system.Solve(config, middle * std::exp2(exponent), ignored)) return;
    const double rounding = system.ExpectedRounding();
    const double error = system.LeaveOneOut({}) + rounding;
    if (error >= least) return;
    least = error;
    best = exponent;
  };
  for (double exponent = -4; exponent <= 4; exponent += 2) attempt(exponent);
  for (const double end : {-4.0, 4.0})
    for (double next = 1.5 * end; best == next - end / 2 && std::abs(next) <= 8; next += end / 2)
      attempt(next);
  for (double step = 1; step >= 0.25; step /= 2) {
    const double around = best;
    attempt(around - step);
    attempt(around + step);
  }
  return middle * std::exp2(best);
}

}  // namespace

std::size_t Rbf::RequiredBytes(const RbfShape& c) noexcept {
  const std::size_t floats =
      2 * c.inputs + c.inputs * Padded(c.samples) + (c.outputs + 1) * Stride(c);
  return floats * sizeof(float) + 5 * kAlignment;
}

std::size_t Rbf::WorkspaceBytes(const RbfShape& s) noexcept {
  return System::WorkspaceBytes(s) + s.outputs * (sizeof(double) + sizeof(float)) +
         2 * alignof(double);
}

Result<> Rbf::Reserve(const RbfShape& capacity, Arena& arena) noexcept {
  if (capacity.samples == 0 || capacity.inputs == 0 || capacity.outputs == 0)
    return Errc::kInvalidArgument;
  origin_ = MakeFloats(arena, capacity.inputs);
  centres_ = MakeFloats(arena, capacity.inputs * Padded(capacity.samples));
  weights_ = MakeFloats(arena, capacity.outputs * Stride(capacity));
  terms_ = MakeFloats(arena, Stride(capacity));
  point_ = MakeFloats(arena, capacity.inputs);
  if (origin_.empty() || centres_.empty() || weights_.empty() || terms_.empty() || point_.empty())
    return Errc::kFull;
  capacity_ = capacity;
  shape_ = {};
  return {};
}

Result<> Rbf::Fit(const RbfConfig& config, const RbfShape& shape, std::span<const float> samples,
                  std::span<const float> targets, std::span<std::byte> workspace, FitReport& report,
                  std::span<float> leave_one_out, std::span<const float> weights) noexcept {
  report = {};
  shape_ = {};
  if (shape.samples > capacity_.samples || shape.inputs > capacity_.inputs ||
      shape.outputs > capacity_.outputs || shape.tail_size() > capacity_.tail_size())
    return Errc::kFull;
  const bool names_a_choice =
      config.epsilon == kAutomaticEpsilon || config.epsilon == kMeanDistanceEpsilon;
  if (shape.tail != config.tail ||
      (!leave_one_out.empty() && leave_one_out.size() != targets.size()) ||
      !(config.epsilon > 0 || names_a_choice) || !(config.smoothing >= 0) ||
      !(config.tail_smoothing >= 0))
    return Errc::kInvalidArgument;
  Arena arena(workspace);
  const auto rounded = arena.MakeArray<float>(shape.outputs);
  const auto allowed = arena.MakeArray<double>(shape.outputs);
  System system;
  if (auto configured =
          system.Configure(shape, samples, targets, workspace.subspan(arena.used()), weights);
      !configured)
    return configured;
  double epsilon = config.epsilon;
  if (names_a_choice) {
    const double middle = system.mean_distance() > 0 ? 1.0 / system.mean_distance() : 1.0;
    epsilon = config.epsilon == kAutomaticEpsilon && HasShape(config.kernel)
                  ? BestEpsilon(config, middle, system)
                  : middle;
  }
  // As Evaluate will see it.
  epsilon = static_cast<float>(epsilon);
  if (auto solved = system.Solve(config, epsilon, report); !solved) return solved;
  Store(system, config.kernel);
  if (!AgreesAtSamples(system, rounded, allowed)) {
    shape_ = {};
    system.Blame(report);
    return Errc::kSingular;
  }
  if (!leave_one_out.empty()) system.LeaveOneOut(leave_one_out);
  return {};
}

bool Rbf::AgreesAtSamples(const System& system, std::span<float> rounded,
                          std::span<double> allowed) const noexcept {
  for (std::size_t o = 0; o < shape_.outputs; ++o)
    allowed[o] = kMaxRounding * system.largest_target(o);
  for (std::size_t s = 0; s < shape_.samples; ++s) {
    Evaluate(system.sample(s), rounded);
    for (std::size_t o = 0; o < shape_.outputs; ++o)
      if (!(std::abs(system.AtSample(s, o) - rounded[o]) <= allowed[o])) return false;
  }
  return true;
}

void Rbf::Store(const System& system, Kernel kernel) noexcept {
  shape_ = system.shape();
  kernel_ = kernel;
  epsilon_ = static_cast<float>(system.epsilon());
  tail_at_ = Padded(shape_.samples);
  stride_ = Stride(shape_);
  std::ranges::fill(centres_, 0.0F);
  std::ranges::fill(weights_, 0.0F);
  for (std::size_t i = 0; i < shape_.inputs; ++i) {
    origin_[i] = static_cast<float>(system.mean(i));
    for (std::size_t s = 0; s < shape_.samples; ++s)
      centres_[(s / kBlock * shape_.inputs + i) * kBlock + s % kBlock] =
          static_cast<float>(epsilon_ * (system.sample(s)[i] - system.mean(i)));
  }
  for (std::size_t row = 0; row < system.size(); ++row) {
    const bool is_tail = row >= shape_.samples;
    const std::size_t at = is_tail ? tail_at_ + row - shape_.samples : row;
    for (std::size_t o = 0; o < shape_.outputs; ++o)
      weights_[o * stride_ + at] = static_cast<float>(system.weight(row, o));
  }
}

void Rbf::Evaluate(std::span<const float> x, std::span<float> y,
                   std::span<float> squared_distances) const noexcept {
  if (shape_.samples == 0) {
    std::ranges::fill(y, 0.0F);
    return;
  }
  for (std::size_t i = 0; i < shape_.inputs; ++i) point_[i] = epsilon_ * (x[i] - origin_[i]);
  float* terms = terms_.data();
  for (std::size_t s = 0; s < tail_at_; s += kBlock)
    SquaredDistances(point_.data(), centres_.data() + s * shape_.inputs, shape_.inputs, terms + s);
  const float to_inputs = 1 / (epsilon_ * epsilon_);
  for (std::size_t s = 0; s < squared_distances.size(); ++s)
    squared_distances[s] = to_inputs * terms[s];
  ApplyKernel(kernel_, terms, tail_at_);
  std::fill(terms + tail_at_, terms + stride_, 0.0F);
  if (shape_.tail != Tail::kNone) terms[tail_at_] = 1;
  if (shape_.tail == Tail::kLinear) std::copy_n(point_.data(), shape_.inputs, terms + tail_at_ + 1);
  for (std::size_t o = 0; o < shape_.outputs; ++o)
    y[o] = DotProduct(terms, weights_.data() + o * stride_, stride_);
}

}  // namespace facewire::rbf
