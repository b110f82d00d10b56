#include "core/rbf/rbf.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>

#include "core/rbf/lanes.h"
#include "core/rbf/linear_solver.h"

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

bool AllFinite(std::span<const float> values) noexcept {
  return std::ranges::all_of(values, [](float v) { return std::isfinite(v); });
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
  }
}

}  // namespace

double Phi(Kernel kernel, double u_squared) noexcept {
  switch (kernel) {
    case Kernel::kMultiquadric:
      return std::sqrt(1.0 + u_squared);
    case Kernel::kInverseMultiquadric:
      return 1.0 / std::sqrt(1.0 + u_squared);
    case Kernel::kGaussian:
      return std::exp(-u_squared);
    case Kernel::kLinear:
      return std::sqrt(u_squared);
    case Kernel::kCubic:
      return u_squared * std::sqrt(u_squared);
  }
  return 0;
}

// One linear system, in the workspace.
struct Rbf::Problem {
  RbfShape shape;
  std::span<const float> samples, targets;
  std::span<double> squared;  // samples x samples: squared distances
  std::span<double> mean;     // inputs
  std::span<double> matrix;   // size x size
  std::span<double> weights;  // size x outputs
  std::span<double> work;     // size
  std::span<std::uint32_t> pivots;
  LinearSolver solver;
  float epsilon = 1;

  std::size_t size() const noexcept { return pivots.size(); }

  double Input(std::size_t sample, std::size_t i) const noexcept {
    return samples[sample * shape.inputs + i] - mean[i];
  }

  void MeasureDistances() noexcept {
    for (std::size_t i = 0; i < shape.inputs; ++i) {
      double sum = 0;
      for (std::size_t s = 0; s < shape.samples; ++s) sum += samples[s * shape.inputs + i];
      mean[i] = sum / static_cast<double>(shape.samples);
    }
    for (std::size_t a = 0; a < shape.samples; ++a) {
      for (std::size_t b = 0; b <= a; ++b) {
        double sum = 0;
        for (std::size_t i = 0; i < shape.inputs; ++i) {
          const double d = static_cast<double>(samples[a * shape.inputs + i]) -
                           static_cast<double>(samples[b * shape.inputs + i]);
          sum += d * d;
        }
        squared[a * shape.samples + b] = squared[b * shape.samples + a] = sum;
      }
    }
  }

  double TailTerm(std::size_t sample, std::size_t column) const noexcept {
    return column == 0 ? 1.0 : Input(sample, column - 1);
  }

  Result<> Solve(const RbfConfig& config) noexcept {
    const std::size_t n = shape.samples;
    const std::size_t m = size();
    const double sign = SmoothingSign(config.kernel);
    const double scale = static_cast<double>(epsilon) * epsilon;
    for (std::size_t row = 0; row < n; ++row) {
      for (std::size_t c = 0; c < n; ++c)
        matrix[row * m + c] = Phi(config.kernel, scale * squared[row * n + c]);
      matrix[row * m + row] += sign * config.smoothing;
      for (std::size_t c = n; c < m; ++c)
        matrix[row * m + c] = matrix[c * m + row] = TailTerm(row, c - n);
    }
    for (std::size_t row = n; row < m; ++row) {
      for (std::size_t c = n; c < m; ++c) matrix[row * m + c] = 0;
      // The constant is never damped: it only says where zero is.
      if (row > n) matrix[row * m + row] = -sign * config.tail_smoothing;
    }
    if (auto factorised = solver.Factorise(matrix, pivots); !factorised) return factorised;
    std::ranges::fill(weights, 0.0);
    std::ranges::copy(targets, weights.begin());
    solver.Solve(weights, shape.outputs);
    return {};
  }

  // Sum of the squared leave-one-out errors; the errors themselves when `errors` is not empty.
  double LeaveOneOut(std::span<float> errors) noexcept {
    double sum = 0;
    for (std::size_t s = 0; s < shape.samples; ++s) {
      const double diagonal = solver.InverseDiagonal(s, work);
      for (std::size_t o = 0; o < shape.outputs; ++o) {
        const double error = weights[s * shape.outputs + o] / diagonal;
        if (!errors.empty()) errors[s * shape.outputs + o] = static_cast<float>(error);
        sum += error * error;
      }
    }
    return std::isfinite(sum) ? sum : std::numeric_limits<double>::infinity();
  }
};

std::size_t Rbf::RequiredBytes(const RbfShape& c) noexcept {
  const std::size_t floats =
      2 * c.inputs + c.inputs * Padded(c.samples) + (c.outputs + 1) * Stride(c);
  return floats * sizeof(float) + 5 * kAlignment;
}

std::size_t Rbf::WorkspaceBytes(const RbfShape& s) noexcept {
  const std::size_t size = s.samples + s.tail_size();
  const std::size_t doubles =
      s.samples * s.samples + s.inputs + size * size + size * s.outputs + size;
  return doubles * sizeof(double) + size * sizeof(std::uint32_t) + 6 * alignof(double);
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
                  std::span<float> leave_one_out) noexcept {
  report = {};
  shape_ = {};
  if (shape.samples > capacity_.samples || shape.inputs > capacity_.inputs ||
      shape.outputs > capacity_.outputs || shape.tail_size() > capacity_.tail_size())
    return Errc::kFull;
  if (shape.samples == 0 || shape.inputs == 0 || shape.outputs == 0 || shape.tail != config.tail ||
      samples.size() != shape.samples * shape.inputs ||
      targets.size() != shape.samples * shape.outputs ||
      (!leave_one_out.empty() && leave_one_out.size() != targets.size()) || !AllFinite(samples) ||
      !AllFinite(targets) || !(config.epsilon >= 0 || config.epsilon == kMeanDistanceEpsilon) ||
      !(config.smoothing >= 0) || !(config.tail_smoothing >= 0))
    return Errc::kInvalidArgument;

  Arena arena(workspace);
  const std::size_t size = shape.samples + shape.tail_size();
  Problem problem{shape, samples, targets, {}, {}, {}, {}, {}, {}, {}, 1};
  problem.squared = arena.MakeArray<double>(shape.samples * shape.samples);
  problem.mean = arena.MakeArray<double>(shape.inputs);
  problem.matrix = arena.MakeArray<double>(size * size);
  problem.weights = arena.MakeArray<double>(size * shape.outputs);
  problem.work = arena.MakeArray<double>(size);
  problem.pivots = arena.MakeArray<std::uint32_t>(size);
  if (problem.pivots.empty() || problem.work.empty() || problem.weights.empty() ||
      problem.matrix.empty() || problem.mean.empty() || problem.squared.empty())
    return Errc::kInvalidArgument;

  problem.MeasureDistances();
  if (config.smoothing == 0) {
    // Relative to the spread of the samples; 1e-12 of a squared distance is 1e-6 of a distance,
    // where float inputs stop telling samples apart.
    const double spread = *std::ranges::max_element(problem.squared);
    for (std::size_t a = 0; a < shape.samples; ++a) {
      for (std::size_t b = 0; b < a; ++b) {
        if (problem.squared[a * shape.samples + b] > 1e-12 * spread) continue;
        report.duplicate_first = b;
        report.duplicate_second = a;
        return Errc::kSingular;
      }
    }
  }
  problem.epsilon = config.epsilon;
  if (config.epsilon <= 0) {
    if (auto chosen = ChooseEpsilon(config, problem); !chosen) return chosen;
  }
  report.epsilon = problem.epsilon;
  if (auto solved = problem.Solve(config); !solved) {
    const std::size_t column = problem.solver.dependent_column();
    if (column < shape.samples) {
      report.dependent_sample = column;
    } else {
      report.tail_undetermined = true;
    }
    return solved;
  }
  if (!leave_one_out.empty()) problem.LeaveOneOut(leave_one_out);
  kernel_ = config.kernel;
  Store(problem);
  return {};
}

// Scans two decades around the reciprocal of the mean distance, then halves the step around the
// best. Shapes whose system is singular count as infinitely bad.
Result<> Rbf::ChooseEpsilon(const RbfConfig& config, Problem& problem) const noexcept {
  const auto pairs = static_cast<double>(problem.squared.size());
  double sum = 0;
  for (const double squared : problem.squared) sum += std::sqrt(squared);
  const double base = sum > 0 ? pairs / sum : 1.0;
  problem.epsilon = static_cast<float>(base);
  if (!HasShape(config.kernel) || config.epsilon == kMeanDistanceEpsilon) return {};

  double best = std::numeric_limits<double>::infinity();
  double best_exponent = 0;
  const auto attempt = [&](double exponent) noexcept {
    problem.epsilon = static_cast<float>(base * std::exp2(exponent));
    if (!problem.Solve(config)) return;
    const double error = problem.LeaveOneOut({});
    if (error >= best) return;
    best = error;
    best_exponent = exponent;
  };
  for (int exponent = -4; exponent <= 4; ++exponent) attempt(exponent);
  for (double step = 0.5; step > 0.1; step /= 2) {
    const double middle = best_exponent;
    attempt(middle - step);
    attempt(middle + step);
  }
  problem.epsilon = static_cast<float>(base * std::exp2(best_exponent));
  return {};
}

void Rbf::Store(const Problem& problem) noexcept {
  shape_ = problem.shape;
  epsilon_ = problem.epsilon;
  tail_at_ = Padded(shape_.samples);
  stride_ = Stride(shape_);
  std::ranges::fill(centres_, 0.0F);
  std::ranges::fill(weights_, 0.0F);
  for (std::size_t i = 0; i < shape_.inputs; ++i) {
    origin_[i] = static_cast<float>(problem.mean[i]);
    for (std::size_t s = 0; s < shape_.samples; ++s)
      centres_[(s / kBlock * shape_.inputs + i) * kBlock + s % kBlock] =
          static_cast<float>(epsilon_ * problem.Input(s, i));
  }
  for (std::size_t row = 0; row < problem.size(); ++row) {
    const bool is_tail = row >= shape_.samples;
    const std::size_t at = is_tail ? tail_at_ + row - shape_.samples : row;
    // Evaluate works in units of 1 / epsilon; the tail's linear columns are brought there too.
    const double scale = row > shape_.samples ? 1.0 / epsilon_ : 1.0;
    for (std::size_t o = 0; o < shape_.outputs; ++o)
      weights_[o * stride_ + at] =
          static_cast<float>(scale * problem.weights[row * shape_.outputs + o]);
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
