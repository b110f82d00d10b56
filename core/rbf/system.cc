#include "core/rbf/system.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace facewire::rbf {
namespace {

// Beyond this condition fewer than four of double's digits are left in the weights.
constexpr double kMaxCondition = 1e12;
// Samples nearer than this part of the mean distance are called duplicates when the system is
// ill-conditioned.
constexpr double kNearlySame = 1e-3;
// Squared, and relative to the largest distance: 1e-6 of a distance is where float inputs stop
// telling samples apart.
constexpr double kSame = 1e-12;

bool AllFinite(std::span<const float> values) noexcept {
  return std::ranges::all_of(values, [](float v) { return std::isfinite(v); });
}

// Four sums at a time: one long chain of additions would wait for itself.
double SquaredDistance(const float* __restrict a, const float* __restrict b,
                       std::size_t n) noexcept {
  std::array<double, 4> sums{};
  std::size_t i = 0;
  const auto square = [&](std::size_t at) {
    const double d = static_cast<double>(a[at]) - static_cast<double>(b[at]);
    return d * d;
  };
  for (; i + 4 <= n; i += 4)
    for (std::size_t lane = 0; lane < sums.size(); ++lane) sums[lane] += square(i + lane);
  for (; i < n; ++i) sums[0] += square(i);
  return (sums[0] + sums[1]) + (sums[2] + sums[3]);
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
    case Kernel::kThinPlate:
      return u_squared > 0 ? 0.5 * u_squared * std::log(u_squared) : 0.0;
  }
  return 0;
}

std::size_t System::WorkspaceBytes(const RbfShape& s) noexcept {
  const std::size_t size = s.samples + s.tail_size();
  const std::size_t doubles =
      s.samples * s.samples + s.inputs + size * size + size * s.outputs + size;
  return doubles * sizeof(double) + size * sizeof(std::uint32_t) + 6 * alignof(double);
}

Result<> System::Configure(const RbfShape& shape, std::span<const float> samples,
                           std::span<const float> targets, std::span<std::byte> workspace,
                           std::span<const float> weights) noexcept {
  if (shape.samples == 0 || shape.inputs == 0 || shape.outputs == 0 ||
      samples.size() != shape.samples * shape.inputs ||
      targets.size() != shape.samples * shape.outputs || !AllFinite(samples) ||
      !AllFinite(targets) || (!weights.empty() && weights.size() != shape.samples) ||
      !AllFinite(weights) || !std::ranges::all_of(weights, [](float w) { return w > 0; }))
    return Errc::kInvalidArgument;
  const std::size_t size = shape.samples + shape.tail_size();
  Arena arena(workspace);
  shape_ = shape;
  samples_ = samples;
  targets_ = targets;
  sample_weights_ = weights;
  squared_ = arena.MakeArray<double>(shape.samples * shape.samples);
  mean_ = arena.MakeArray<double>(shape.inputs);
  matrix_ = arena.MakeArray<double>(size * size);
  weights_ = arena.MakeArray<double>(size * shape.outputs);
  work_ = arena.MakeArray<double>(size);
  pivots_ = arena.MakeArray<std::uint32_t>(size);
  if (pivots_.empty() || work_.empty() || weights_.empty() || matrix_.empty() || mean_.empty() ||
      squared_.empty())
    return Errc::kInvalidArgument;
  MeasureDistances();
  return {};
}

void System::MeasureDistances() noexcept {
  const std::size_t n = shape_.samples;
  for (std::size_t i = 0; i < shape_.inputs; ++i) {
    double sum = 0;
    for (std::size_t s = 0; s < n; ++s) sum += samples_[s * shape_.inputs + i];
    mean_[i] = sum / static_cast<double>(n);
  }
  double sum = 0;
  for (std::size_t a = 0; a < n; ++a) {
    squared_[a * n + a] = 0;
    for (std::size_t b = 0; b < a; ++b) {
      const double squared = SquaredDistance(sample(a).data(), sample(b).data(), shape_.inputs);
      squared_[a * n + b] = squared_[b * n + a] = squared;
      sum += std::sqrt(squared);
    }
  }
  mean_distance_ = n > 1 ? sum / (0.5 * static_cast<double>(n * (n - 1))) : 0.0;
}

double System::TailTerm(std::span<const float> x, std::size_t column) const noexcept {
  return column == 0 ? 1.0 : epsilon_ * (static_cast<double>(x[column - 1]) - mean_[column - 1]);
}

void System::FillMatrix(const RbfConfig& config) noexcept {
  const std::size_t n = shape_.samples;
  const std::size_t m = size();
  const double scale = epsilon_ * epsilon_;
  for (std::size_t row = 0; row < n; ++row) {
    for (std::size_t c = 0; c <= row; ++c)
      matrix_[row * m + c] = matrix_[c * m + row] =
          Phi(config.kernel, scale * squared_[row * n + c]);
    matrix_[row * m + row] += SmoothingOf(row);
    for (std::size_t c = n; c < m; ++c)
      matrix_[row * m + c] = matrix_[c * m + row] = TailTerm(sample(row), c - n);
  }
  for (std::size_t row = n; row < m; ++row) {
    for (std::size_t c = n; c < m; ++c) matrix_[row * m + c] = 0;
    // The constant is never damped: it only says where zero is.
    if (row > n)
      matrix_[row * m + row] = -SmoothingSign(config.kernel) * config.tail_smoothing * scale;
  }
  largest_row_sum_ = largest_element_ = 0;
  for (std::size_t row = 0; row < m; ++row) {
    double sum = 0;
    for (std::size_t c = 0; c < m; ++c) {
      const double element = std::abs(matrix_[row * m + c]);
      sum += element;
      largest_element_ = std::max(largest_element_, element);
    }
    largest_row_sum_ = std::max(largest_row_sum_, sum);
  }
}

bool System::FindDuplicate(FitReport& report) const noexcept {
  const double spread = *std::ranges::max_element(squared_);
  for (std::size_t a = 0; a < shape_.samples; ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      if (squared_[a * shape_.samples + b] > kSame * spread) continue;
      report.duplicate_first = b;
      report.duplicate_second = a;
      return true;
    }
  }
  return false;
}

Result<> System::Solve(const RbfConfig& config, double epsilon, FitReport& report) noexcept {
  report = {};
  report.epsilon = static_cast<float>(epsilon);
  if (config.smoothing == 0 && FindDuplicate(report)) return Errc::kSingular;
  kernel_ = config.kernel;
  epsilon_ = epsilon;
  smoothing_ = SmoothingSign(config.kernel) * config.smoothing;
  FillMatrix(config);
  if (auto factorised = solver_.Factorise(matrix_, pivots_); !factorised) {
    if (factorised.error() == Errc::kSingular) {
      const std::size_t column = solver_.dependent_column();
      if (column < shape_.samples) {
        report.dependent_sample = column;
      } else {
        report.tail_undetermined = true;
      }
    }
    return factorised;
  }
  if (!(EstimateCondition() <= kMaxCondition)) {
    Blame(report);
    return Errc::kSingular;
  }
  std::ranges::fill(weights_, 0.0);
  std::ranges::copy(targets_, weights_.begin());
  solver_.Solve(weights_, shape_.outputs);
  return {};
}

// Inverse iteration: multiplying by the inverse again and again leaves the direction in which the
// (symmetric) matrix is smallest in work_, and how small it is there. Three rounds from a vector
// with a bit of everything find the order of magnitude, which is all that is asked.
double System::EstimateCondition() noexcept {
  const std::size_t m = size();
  for (std::size_t i = 0; i < m; ++i)
    work_[i] = (i % 2 == 0 ? 1.0 : -1.0) + 1.0 / static_cast<double>(3 + i);
  double growth = 0;
  for (int round = 0; round < 3; ++round) {
    double largest = 0;
    for (const double v : work_) largest = std::max(largest, std::abs(v));
    for (double& v : work_) v /= largest;
    solver_.Solve(work_, 1);
    growth = 0;
    for (const double v : work_) growth = std::max(growth, std::abs(v));
    if (!std::isfinite(growth)) return growth;
  }
  return largest_row_sum_ * growth;
}

void System::Blame(FitReport& report) noexcept {
  EstimateCondition();
  const auto smaller = [](double a, double b) { return std::abs(a) < std::abs(b); };
  const auto worst =
      static_cast<std::size_t>(std::ranges::max_element(work_, smaller) - work_.begin());
  if (worst >= shape_.samples) {
    report.tail_undetermined = true;
    return;
  }
  std::size_t nearest = worst == 0 ? shape_.samples - 1 : 0;
  const std::span<const double> distances =
      squared_.subspan(worst * shape_.samples, shape_.samples);
  for (std::size_t s = 0; s < shape_.samples; ++s)
    if (s != worst && distances[s] < distances[nearest]) nearest = s;
  if (nearest != worst && std::sqrt(distances[nearest]) < kNearlySame * mean_distance_) {
    report.duplicate_first = std::min(worst, nearest);
    report.duplicate_second = std::max(worst, nearest);
  } else {
    report.dependent_sample = worst;
  }
}

double System::LeaveOneOut(std::span<float> errors) noexcept {
  solver_.TakeInverseDiagonal(work_);
  double sum = 0;
  for (std::size_t s = 0; s < shape_.samples; ++s) {
    for (std::size_t o = 0; o < shape_.outputs; ++o) {
      const double error = weight(s, o) / work_[s];
      if (!errors.empty()) errors[s * shape_.outputs + o] = static_cast<float>(error);
      sum += error * error;
    }
  }
  return std::isfinite(sum) ? sum : std::numeric_limits<double>::infinity();
}

double System::ExpectedRounding() const noexcept {
  // A term rounds in its last bit, and so do the coordinates behind its distance: a few bits.
  const double rounding = 8 * std::numeric_limits<float>::epsilon() * largest_element_;
  double sum = 0;
  for (std::size_t o = 0; o < shape_.outputs; ++o) {
    double squares = 0;  // rounding errors of the terms are independent, so their squares add up
    for (std::size_t row = 0; row < size(); ++row) squares += weight(row, o) * weight(row, o);
    sum += rounding * rounding * squares * static_cast<double>(shape_.samples);
  }
  return sum;
}

double System::AtSample(std::size_t sample, std::size_t output) const noexcept {
  return targets_[sample * shape_.outputs + output] - SmoothingOf(sample) * weight(sample, output);
}

double System::largest_target(std::size_t output) const noexcept {
  double largest = 0;
  for (std::size_t s = 0; s < shape_.samples; ++s)
    largest =
        std::max(largest, std::abs(static_cast<double>(targets_[s * shape_.outputs + output])));
  return largest;
}

void System::Evaluate(std::span<const float> x, std::span<double> y) const noexcept {
  std::ranges::fill(y, 0.0);
  const double scale = epsilon_ * epsilon_;
  for (std::size_t row = 0; row < size(); ++row) {
    const double term =
        row < shape_.samples
            ? Phi(kernel_, scale * SquaredDistance(x.data(), sample(row).data(), shape_.inputs))
            : TailTerm(x, row - shape_.samples);
    for (std::size_t o = 0; o < shape_.outputs; ++o) y[o] += term * weight(row, o);
  }
}

}  // namespace facewire::rbf
