#include <benchmark/benchmark.h>

#include <memory>

#include "core/limit/limiter.h"

namespace facewire::limit {
namespace {

// All channels moving under both limits, which is the dearest case.
void LimitAFullRig(benchmark::State& state) {
  auto rig = std::make_unique<Rig>();
  Channel channel;
  channel.max_speed_per_s = 5;
  channel.max_acceleration_per_s2 = 50;
  while (rig->channels.try_push(channel)) {
  }
  Limiter limiter;
  if (!limiter.Configure(*rig)) state.SkipWithError("the rig was refused");
  RigPose target = rig->NeutralPose();
  Time now{};
  int frame = 0;
  for (auto _ : state) {
    if (frame++ % 10 == 0) target.values.fill(target.values[0] > 0.5F ? 0 : 1);
    now += std::chrono::milliseconds(33);
    benchmark::DoNotOptimize(limiter.Update(target, now));
  }
}
BENCHMARK(LimitAFullRig)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace facewire::limit
