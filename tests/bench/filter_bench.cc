#include <benchmark/benchmark.h>

#include "core/filter/landmark_filter.h"
#include "tests/support/generated_face.h"

namespace facewire::filter {
namespace {

void FilterOneFrame(benchmark::State& state) {
  Landmarks face = test::Photograph(test::GeneratedFace(), {});
  LandmarkFilter filter{FilterConfig{}};
  float sway_px = 1;
  for (auto _ : state) {
    face.captured += std::chrono::milliseconds(33);
    for (Point3& p : face.points_px) p.x += sway_px;
    sway_px = -sway_px;
    auto out = filter.Update(face);
    if (!out) state.SkipWithError("the face was rejected");
    benchmark::DoNotOptimize(out);
  }
}
BENCHMARK(FilterOneFrame)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace facewire::filter
