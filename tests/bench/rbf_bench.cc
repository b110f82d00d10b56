#include <benchmark/benchmark.h>

#include <cmath>
#include <random>
#include <vector>

#include "core/rbf/rbf.h"

namespace facewire::rbf {
namespace {

// 600 samples of 300 inputs, 60 outputs: a whole face without regions or axes. Like a face, the
// inputs move together: 40 hidden coordinates and a little noise.
struct WholeFace {
  RbfShape shape{600, 300, 60, Tail::kNone};
  std::vector<float> samples, targets, errors;
  std::vector<std::byte> block, workspace;
  Rbf rbf;
  FitReport report;

  explicit WholeFace(Tail tail) {
    shape.tail = tail;
    constexpr std::size_t kHidden = 40;
    std::minstd_rand random(1);
    std::normal_distribution<float> normal;
    std::vector<float> basis(kHidden * shape.inputs);
    for (float& value : basis) value = 0.1F * normal(random);
    for (std::size_t s = 0; s < shape.samples; ++s) {
      std::vector<float> hidden(kHidden);
      for (float& value : hidden) value = std::abs(normal(random));
      for (std::size_t i = 0; i < shape.inputs; ++i) {
        float sum = 0.02F * normal(random);
        for (std::size_t h = 0; h < kHidden; ++h) sum += hidden[h] * basis[h * shape.inputs + i];
        samples.push_back(sum);
      }
      for (std::size_t o = 0; o < shape.outputs; ++o)
        targets.push_back(hidden[o % kHidden] * hidden[(o + 1) % kHidden]);
    }
    errors.resize(targets.size());
    block.resize(Rbf::RequiredBytes(shape));
    workspace.resize(Rbf::WorkspaceBytes(shape));
  }

  bool Fit(float epsilon) {
    Arena arena(block);
    const RbfConfig config{.tail = shape.tail, .epsilon = epsilon, .smoothing = 0.01F};
    return rbf.Reserve(shape, arena) &&
           rbf.Fit(config, shape, samples, targets, workspace, report, errors);
  }
};

void Fit(benchmark::State& state, Tail tail, float epsilon) {
  WholeFace face(tail);
  for (auto _ : state)
    if (!face.Fit(epsilon)) state.SkipWithError("fit");
  state.counters["epsilon"] = static_cast<double>(face.report.epsilon);
}
BENCHMARK_CAPTURE(Fit, no_tail_given, Tail::kNone, 0.1F)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Fit, no_tail_automatic, Tail::kNone, kAutomaticEpsilon)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Fit, linear_tail_given, Tail::kLinear, 0.1F)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Fit, linear_tail_automatic, Tail::kLinear, kAutomaticEpsilon)
    ->Unit(benchmark::kMillisecond);

void Evaluate(benchmark::State& state, Tail tail) {
  WholeFace face(tail);
  if (!face.Fit(0.1F)) state.SkipWithError("fit");
  std::vector<float> y(face.shape.outputs);
  for (auto _ : state) {
    face.rbf.Evaluate(std::span<const float>(face.samples).first(face.shape.inputs), y);
    benchmark::DoNotOptimize(y.data());
  }
}
BENCHMARK_CAPTURE(Evaluate, no_tail, Tail::kNone)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(Evaluate, linear_tail, Tail::kLinear)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace facewire::rbf
