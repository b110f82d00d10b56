#include "core/nnls/basis.h"

#include <algorithm>
#include <cmath>

namespace facewire::nnls {
namespace {

// Keeps at zero what no sample determines; far below what it changes elsewhere. T counts in whole
// units, so it needs no scale of its own.
constexpr double kRidge = 1e-9;

void AddScaled(double factor, std::span<const double> x, std::span<double> y) noexcept {
  for (std::size_t i = 0; i < x.size(); ++i) y[i] += factor * x[i];
}

std::span<double> Row(std::span<double> matrix, std::size_t row, std::size_t columns) noexcept {
  return matrix.subspan(row * columns, columns);
}

}  // namespace

std::size_t Basis::WorkspaceBytes(const NnlsShape& s) noexcept {
  const std::size_t doubles =
      s.samples * (s.inputs + s.outputs) + s.outputs * (s.outputs + s.inputs + 2) + s.inputs;
  return (doubles + 1) * sizeof(double) + s.outputs * sizeof(std::uint32_t);
}

Result<> Basis::Take(const NnlsShape& shape, Arena& arena) noexcept {
  shape_ = shape;
  motion_ = arena.MakeArray<double>(shape.samples * shape.inputs);
  weights_ = arena.MakeArray<double>(shape.samples * shape.outputs);
  units_ = arena.MakeArray<double>(shape.outputs);
  normal_ = arena.MakeArray<double>(shape.outputs * shape.outputs);
  basis_ = arena.MakeArray<double>(shape.outputs * shape.inputs);
  column_ = arena.MakeArray<double>(shape.outputs);
  error_ = arena.MakeArray<double>(shape.inputs);
  pivots_ = arena.MakeArray<std::uint32_t>(shape.outputs);
  for (const auto* part : {&motion_, &weights_, &units_, &normal_, &basis_, &column_, &error_})
    if (part->empty()) return Errc::kInvalidArgument;
  if (pivots_.empty()) return Errc::kInvalidArgument;
  return {};
}

Result<> Basis::Estimate(std::span<const float> samples, std::span<const float> targets,
                         std::size_t neutral) noexcept {
  const auto [count, inputs, outputs] = shape_;
  for (std::size_t o = 0; o < outputs; ++o) {
    const double rest = targets[neutral * outputs + o];
    units_[o] = 0;
    for (std::size_t s = 0; s < count; ++s)
      units_[o] = std::max(units_[o], std::abs(targets[s * outputs + o] - rest));
    if (units_[o] == 0) units_[o] = 1;
    for (std::size_t s = 0; s < count; ++s)
      weights_[s * outputs + o] = (targets[s * outputs + o] - rest) / units_[o];
  }
  for (std::size_t s = 0; s < count; ++s)
    for (std::size_t i = 0; i < inputs; ++i)
      motion_[s * inputs + i] =
          double{samples[s * inputs + i]} - double{samples[neutral * inputs + i]};
  return Solve();
}

// (T'T + ridge) B = T'D
Result<> Basis::Solve() noexcept {
  std::ranges::fill(normal_, 0.0);
  std::ranges::fill(basis_, 0.0);
  for (std::size_t s = 0; s < shape_.samples; ++s) {
    const auto row = Row(weights_, s, shape_.outputs);
    for (std::size_t o = 0; o < shape_.outputs; ++o) {
      if (row[o] == 0) continue;
      AddScaled(row[o], row, Row(normal_, o, shape_.outputs));
      AddScaled(row[o], Row(motion_, s, shape_.inputs), Row(basis_, o, shape_.inputs));
    }
  }
  for (std::size_t o = 0; o < shape_.outputs; ++o) normal_[o * shape_.outputs + o] += kRidge;
  if (auto factorised = solver_.Factorise(normal_, pivots_); !factorised) return factorised;
  solver_.Solve(basis_, shape_.inputs);
  return {};
}

//     B without s = B - (T'T)^-1 t (d - B't)' / (1 - t'(T'T)^-1 t)
void Basis::LeaveOut(std::size_t s) noexcept {
  const auto weights = Row(weights_, s, shape_.outputs);
  std::ranges::copy(weights, column_.begin());
  solver_.Solve(column_, 1);
  std::ranges::copy(Row(motion_, s, shape_.inputs), error_.begin());
  double influence = 0;
  for (std::size_t o = 0; o < shape_.outputs; ++o) {
    AddScaled(-weights[o], motion(o), error_);
    influence += weights[o] * column_[o];
  }
  // A sample alone with its output has influence 1 / (1 + ridge): never quite 1.
  const double others = std::max(1 - influence, kRidge * kRidge);
  for (double& e : error_) e /= others;
  Change(-1);
}

void Basis::Change(double sign) noexcept {
  for (std::size_t o = 0; o < shape_.outputs; ++o)
    AddScaled(sign * column_[o], error_, Row(basis_, o, shape_.inputs));
}

}  // namespace facewire::nnls
