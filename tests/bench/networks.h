#ifndef FACEWIRE_TESTS_BENCH_NETWORKS_H_
#define FACEWIRE_TESTS_BENCH_NETWORKS_H_

#include <benchmark/benchmark.h>

#include <cstddef>
#include <memory>
#include <vector>

#include "core/track/crop.h"
#include "core/track/landmark_network.h"
#include "core/track/network_memory.h"
#include "core/track/region.h"
#include "core/track/tflite_model.h"
#include "core/track/tracker.h"
#include "tests/support/footage.h"

// What the benchmarks that run networks share: the footage, and the bare landmark networks that
// everything is compared with.
namespace facewire::bench {

inline constexpr int kFrames = 64;

// The beginning of the test footage, decoded, as BGR.
inline const std::vector<test::Picture>& Footage() {
  static const auto pictures = test::ReadFootage("franck.mp4", 0, kFrames);
  return pictures;
}

// Forwards and backwards through the footage, so that no frame is far from the one before.
inline std::size_t PingPong(std::size_t i) {
  const std::size_t period = 2 * kFrames - 2;
  const std::size_t phase = i % period;
  return phase < kFrames ? phase : period - phase;
}

// Where the face is in the first frame.
inline track::Region FaceRegion() {
  return {.center_x_px = 191, .center_y_px = 150, .side_px = 243, .angle_rad = 0.05F};
}

// A network, alone in memory of its own.
template <class Network>
struct Built {
  explicit Built(const std::vector<std::byte>& file) : block(std::size_t{32} << 20), memory(block) {
    if (!track::NetworkMemory::StartXnnpack()) return;
    const auto model = track::TfliteModel::Parse(file);
    ok = model && network.Build(*model, memory);
  }
  std::vector<std::byte> block;
  track::NetworkMemory memory;
  Network network;
  bool ok = false;
};

// A landmark network on one crop: no crop, no tracking.
template <class Network>
void RunLandmarks(benchmark::State& state, track::Model model) {
  const auto built = std::make_unique<Built<Network>>(test::NetworkBytes(model).landmarks);
  if (!built->ok) return state.SkipWithError("the network does not load");
  track::CropRegion(Footage()[0].view(), FaceRegion(), built->network.input());
  auto out = std::make_unique<track::CropLandmarks>();
  for (auto _ : state) benchmark::DoNotOptimize(built->network.Run(*out));
  if (out->presence < 0.5F) state.SkipWithError("no face in the crop");
}
inline void BM_AttentionNetwork(benchmark::State& state) {
  RunLandmarks<track::AttentionNetwork>(state, track::Model::kAttention);
}

// CPU time of the process, which has one thread; medians over repetitions.
inline void Settings(benchmark::internal::Benchmark* b) {
  b->MeasureProcessCPUTime()
      ->Unit(benchmark::kMicrosecond)
      ->Repetitions(9)
      ->MinTime(0.1)
      ->DisplayAggregatesOnly();
}

}  // namespace facewire::bench

#endif  // FACEWIRE_TESTS_BENCH_NETWORKS_H_
