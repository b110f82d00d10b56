#include "core/nnls/nnls.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/rbf/linear_solver.h"

namespace facewire::nnls {
namespace {

// Without one sample its pose may be unknown; such a pose then counts as absent.
constexpr double kLeastRidgeLeaveOneOut = 1e-9;
constexpr int kMaxRounds = 64;
constexpr float kStep = 1e-4F;  // of an output's range: smaller is no change

bool AllFinite(std::span<const float> values) noexcept {
  return std::ranges::all_of(values, [](float v) { return std::isfinite(v); });
}

template <class T>
T Dot(std::span<const T> a, std::span<const T> b) noexcept {
  T sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

template <class T>
void AddScaled(T factor, std::span<const T> x, std::span<T> y) noexcept {
  for (std::size_t i = 0; i < x.size(); ++i) y[i] += factor * x[i];
}

template <class T>
std::span<T> Row(std::span<T> matrix, std::size_t row, std::size_t columns) noexcept {
  return matrix.subspan(row * columns, columns);
}

// Two samples with the same inputs whose targets differ: one of them must be wrong.
void FindContradiction(const NnlsShape& shape, std::span<const float> samples,
                       std::span<const float> targets, NnlsReport& report) noexcept {
  for (std::size_t a = 0; a < shape.samples; ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      if (!std::ranges::equal(Row(samples, a, shape.inputs), Row(samples, b, shape.inputs)) ||
          std::ranges::equal(Row(targets, a, shape.outputs), Row(targets, b, shape.outputs)))
        continue;
      report.duplicate_first = b;
      report.duplicate_second = a;
      return;
    }
  }
}

}  // namespace

// What Evaluate will need, in the workspace.
struct Nnls::Problem {
  Basis basis;
  std::span<double> gram, factors;  // outputs x outputs
  std::span<double> solve;          // outputs x inputs
  std::span<std::uint32_t> pivots;  // outputs

  Result<> Take(const NnlsShape& shape, Arena& arena) noexcept {
    if (auto taken = basis.Take(shape, arena); !taken) return taken;
    gram = arena.MakeArray<double>(shape.outputs * shape.outputs);
    factors = arena.MakeArray<double>(shape.outputs * shape.outputs);
    solve = arena.MakeArray<double>(shape.outputs * shape.inputs);
    pivots = arena.MakeArray<std::uint32_t>(shape.outputs);
    if (gram.empty() || factors.empty() || solve.empty() || pivots.empty())
      return Errc::kInvalidArgument;
    return {};
  }
};

std::size_t Nnls::RequiredBytes(const NnlsShape& s) noexcept {
  return (2 * s.inputs + s.outputs * (s.inputs + s.outputs + 7)) * sizeof(float) + alignof(float);
}

std::size_t Nnls::WorkspaceBytes(const NnlsShape& s) noexcept {
  return Basis::WorkspaceBytes(s) + (s.outputs * (2 * s.outputs + s.inputs) + 1) * sizeof(double) +
         s.outputs * sizeof(std::uint32_t);
}

Result<> Nnls::Reserve(const NnlsShape& shape, Arena& arena) noexcept {
  shape_ = shape;
  rest_ = arena.MakeArray<float>(shape.inputs);
  motion_ = arena.MakeArray<float>(shape.inputs);
  solve_ = arena.MakeArray<float>(shape.outputs * shape.inputs);
  gram_ = arena.MakeArray<float>(shape.outputs * shape.outputs);
  for (auto* part : {&neutral_, &scale_, &low_, &high_, &pull_, &slope_, &weight_})
    *part = arena.MakeArray<float>(shape.outputs);
  if (weight_.empty()) {
    shape_ = {};
    return Errc::kFull;
  }
  return {};
}

Result<> Nnls::Fit(const NnlsConfig& config, const NnlsShape& shape, std::span<const float> samples,
                   std::span<const float> targets, std::size_t neutral,
                   std::span<std::byte> workspace, NnlsReport& report,
                   std::span<float> leave_one_out) noexcept {
  report = {};
  if (shape.inputs != shape_.inputs || shape.outputs != shape_.outputs) return Errc::kFull;
  if (shape.samples == 0 || shape.inputs == 0 || shape.outputs == 0 || neutral >= shape.samples ||
      samples.size() != shape.samples * shape.inputs ||
      targets.size() != shape.samples * shape.outputs ||
      (!leave_one_out.empty() && leave_one_out.size() != targets.size()) || !AllFinite(samples) ||
      !AllFinite(targets) || !(config.ridge >= 0))
    return Errc::kInvalidArgument;
  Arena arena(workspace);
  Problem problem;
  if (auto taken = problem.Take(shape, arena); !taken) return taken;
  if (config.ridge == 0) {
    FindContradiction(shape, samples, targets, report);
    if (report.duplicate_first) return Errc::kSingular;
  }

  std::ranges::copy(Row(samples, neutral, shape.inputs), rest_.begin());
  std::ranges::copy(Row(targets, neutral, shape.outputs), neutral_.begin());
  if (auto solved = problem.basis.Estimate(samples, targets, neutral); !solved) return solved;
  for (std::size_t o = 0; o < shape.outputs; ++o) {
    float low = 0;
    float high = 0;
    for (std::size_t s = 0; s < shape.samples; ++s) {
      low = std::min(low, targets[s * shape.outputs + o] - neutral_[o]);
      high = std::max(high, targets[s * shape.outputs + o] - neutral_[o]);
    }
    scale_[o] = static_cast<float>(problem.basis.unit(o));
    low_[o] = low / scale_[o];
    high_[o] = high / scale_[o];
  }
  for (std::size_t s = 0; !leave_one_out.empty() && s < shape.samples; ++s) {
    problem.basis.LeaveOut(s);
    const double ridge = std::max(double{config.ridge}, kLeastRidgeLeaveOneOut);
    if (auto stored = Store(problem, ridge, report); !stored) return stored;
    problem.basis.PutBack();
    const auto errors = Row(leave_one_out, s, shape.outputs);
    Evaluate(Row(samples, s, shape.inputs), errors);
    for (std::size_t o = 0; o < shape.outputs; ++o)
      errors[o] = targets[s * shape.outputs + o] - errors[o];
  }
  return Store(problem, config.ridge, report);
}

// What Evaluate needs, from the problem's basis.
Result<> Nnls::Store(const Problem& p, double ridge, NnlsReport& report) noexcept {
  const std::size_t k = shape_.outputs;
  double size = 0;  // mean of the diagonal
  for (std::size_t a = 0; a < k; ++a) {
    for (std::size_t b = 0; b <= a; ++b)
      p.gram[a * k + b] = p.gram[b * k + a] = Dot<double>(p.basis.motion(a), p.basis.motion(b));
    size += p.gram[a * k + a] / static_cast<double>(k);
  }
  const double damping = ridge * (size > 0 ? size : 1);  // 0: nothing moves in these samples
  for (std::size_t o = 0; o < k; ++o) p.gram[o * k + o] += damping;
  std::ranges::copy(p.gram, p.factors.begin());
  rbf::LinearSolver solver;
  if (auto factorised = solver.Factorise(p.factors, p.pivots); !factorised) {
    report.dependent_output = solver.dependent_column();
    return factorised;
  }
  for (std::size_t o = 0; o < k; ++o)
    std::ranges::copy(p.basis.motion(o), Row(p.solve, o, shape_.inputs).begin());
  solver.Solve(p.solve, shape_.inputs);
  const auto to_float = [](double v) { return static_cast<float>(v); };
  std::ranges::transform(p.gram, gram_.begin(), to_float);
  std::ranges::transform(p.solve, solve_.begin(), to_float);
  return {};
}

void Nnls::Evaluate(std::span<const float> x, std::span<float> y) const noexcept {
  const std::size_t k = shape_.outputs;
  for (std::size_t i = 0; i < shape_.inputs; ++i) motion_[i] = x[i] - rest_[i];
  // The minimum without bounds, w0; the gradient's constant part is B'd = gram w0.
  for (std::size_t o = 0; o < k; ++o)
    weight_[o] = Dot<float>(Row(solve_, o, shape_.inputs), motion_);
  for (std::size_t o = 0; o < k; ++o) pull_[o] = Dot<float>(Row(gram_, o, k), weight_);
  for (std::size_t o = 0; o < k; ++o) weight_[o] = std::clamp(weight_[o], low_[o], high_[o]);
  for (std::size_t o = 0; o < k; ++o) slope_[o] = pull_[o] - Dot<float>(Row(gram_, o, k), weight_);
  for (int round = 0; round < kMaxRounds; ++round) {
    float largest = 0;
    for (std::size_t o = 0; o < k; ++o) {
      const float wanted = std::clamp(weight_[o] + slope_[o] / gram_[o * k + o], low_[o], high_[o]);
      const float step = wanted - weight_[o];
      if (step == 0) continue;
      weight_[o] = wanted;
      AddScaled<float>(-step, Row(gram_, o, k), slope_);
      largest = std::max(largest, std::abs(step));
    }
    if (largest < kStep) break;
  }
  for (std::size_t o = 0; o < k; ++o) y[o] = neutral_[o] + scale_[o] * weight_[o];
}

}  // namespace facewire::nnls
