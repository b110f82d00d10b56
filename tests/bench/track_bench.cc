// What tracking costs: the bare networks, the crop from each pixel format, and a whole tracked
// frame. All times are CPU time of the process, which has one thread.
#include <benchmark/benchmark.h>

#include <array>
#include <cstddef>
#include <memory>
#include <vector>

#include "core/track/crop.h"
#include "core/track/face_detector.h"
#include "core/track/landmark_network.h"
#include "core/track/tracker.h"
#include "tests/bench/networks.h"
#include "tests/support/footage.h"

namespace facewire::track {
namespace {

using bench::BM_AttentionNetwork;
using bench::Built;
using bench::FaceRegion;
using bench::Footage;
using bench::PingPong;
using bench::Settings;

void BM_DetectorNetworkAndCrop(benchmark::State& state) {
  const auto built =
      std::make_unique<Built<FaceDetector>>(test::NetworkBytes(Model::kMesh).detector);
  if (!built->ok) return state.SkipWithError("the detector does not load");
  for (auto _ : state) {
    benchmark::DoNotOptimize(built->network.Detect(Footage()[0].view(), 0.5F));
  }
}

void BM_MeshNetwork(benchmark::State& state) {
  bench::RunLandmarks<MeshNetwork>(state, Model::kMesh);
}

void BM_Crop(benchmark::State& state, PixelFormat format) {
  const test::Picture picture = Footage()[0].As(format);
  std::vector<float> out(std::size_t{3} * kLandmarkSize * kLandmarkSize);
  for (auto _ : state) {
    CropRegion(picture.view(), FaceRegion(), out);
    benchmark::DoNotOptimize(out.data());
    benchmark::ClobberMemory();
  }
}

void BM_Update(benchmark::State& state, Model model, PixelFormat format) {
  std::vector<test::Picture> pictures;
  for (const auto& picture : Footage()) pictures.push_back(picture.As(format));
  std::vector<std::byte> block(Tracker::RequiredBytes(model));
  Arena arena(block);
  const auto tracker = std::make_unique<Tracker>();
  if (!tracker->Load({.model = model}, test::NetworkBytes(model).files(), arena)) {
    return state.SkipWithError("the tracker does not load");
  }
  std::size_t i = 0;
  if (!tracker->Update(pictures[0].frame())) return state.SkipWithError("no face");
  for (auto _ : state) {
    auto landmarks = tracker->Update(pictures[PingPong(++i)].frame());
    if (!landmarks) return state.SkipWithError("the face is lost");
    benchmark::DoNotOptimize(landmarks);
  }
}

BENCHMARK(BM_DetectorNetworkAndCrop)->Apply(Settings);
BENCHMARK(BM_MeshNetwork)->Apply(Settings);
BENCHMARK(BM_AttentionNetwork)->Apply(Settings);
BENCHMARK_CAPTURE(BM_Crop, grey8, PixelFormat::kGrey8)->Apply(Settings);
BENCHMARK_CAPTURE(BM_Crop, yuyv, PixelFormat::kYuyv)->Apply(Settings);
BENCHMARK_CAPTURE(BM_Crop, nv12, PixelFormat::kNv12)->Apply(Settings);
BENCHMARK_CAPTURE(BM_Crop, i420, PixelFormat::kI420)->Apply(Settings);
BENCHMARK_CAPTURE(BM_Crop, rgb24, PixelFormat::kRgb24)->Apply(Settings);
BENCHMARK_CAPTURE(BM_Crop, bgr24, PixelFormat::kBgr24)->Apply(Settings);
BENCHMARK_CAPTURE(BM_Update, mesh_bgr24, Model::kMesh, PixelFormat::kBgr24)->Apply(Settings);
BENCHMARK_CAPTURE(BM_Update, attention_bgr24, Model::kAttention, PixelFormat::kBgr24)
    ->Apply(Settings);
BENCHMARK_CAPTURE(BM_Update, attention_yuyv, Model::kAttention, PixelFormat::kYuyv)
    ->Apply(Settings);

}  // namespace
}  // namespace facewire::track
