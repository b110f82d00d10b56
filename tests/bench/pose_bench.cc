#include <benchmark/benchmark.h>

#include "core/pose/pose_estimator.h"
#include "tests/support/generated_face.h"

namespace facewire::pose {
namespace {

void EstimateOnePose(benchmark::State& state) {
  const Landmarks face =
      test::Photograph(test::GeneratedFace(), {.rotation = test::Rotation(10, 20, 5)});
  const PoseEstimator estimator{PoseConfig{}};
  for (auto _ : state) {
    auto pose = estimator.Update(face);
    if (!pose) state.SkipWithError("the face was rejected");
    benchmark::DoNotOptimize(pose);
  }
}
BENCHMARK(EstimateOnePose)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace facewire::pose
