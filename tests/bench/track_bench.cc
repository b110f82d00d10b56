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
#include "core/track/network_memory.h"
#include "core/track/tflite_model.h"
#include "core/track/tracker.h"
#include "tests/core/track/footage.h"

namespace facewire::track {
namespace {

constexpr const char* kClip = "franck.mp4";
constexpr int kFrames = 64;

const std::vector<test::Picture>& Footage() {
  static const auto pictures = test::ReadFootage(kClip, 0, kFrames);
  return pictures;
}

// Forwards and backwards through the footage, so that no frame is far from the one before.
std::size_t PingPong(std::size_t i) {
  const std::size_t period = 2 * kFrames - 2;
  const std::size_t phase = i % period;
  return phase < kFrames ? phase : period - phase;
}

// Where the face is in the first frame.
Region FaceRegion() {
  return {.center_x_px = 191, .center_y_px = 150, .side_px = 243, .angle_rad = 0.05F};
}

template <class Network>
struct Built {
  explicit Built(const std::vector<std::byte>& file) : block(std::size_t{32} << 20), memory(block) {
    if (!NetworkMemory::StartXnnpack()) return;
    const auto model = TfliteModel::Parse(file);
    ok = model && network.Build(*model, memory);
  }
  std::vector<std::byte> block;
  NetworkMemory memory;
  Network network;
  bool ok = false;
};

void BM_DetectorNetworkAndCrop(benchmark::State& state) {
  const auto built =
      std::make_unique<Built<FaceDetector>>(test::NetworkBytes(Model::kMesh).detector);
  if (!built->ok) return state.SkipWithError("the detector does not load");
  for (auto _ : state) {
    benchmark::DoNotOptimize(built->network.Detect(Footage()[0].view(), 0.5F));
  }
}

template <class Network>
void RunLandmarks(benchmark::State& state, Model model) {
  const auto built = std::make_unique<Built<Network>>(test::NetworkBytes(model).landmarks);
  if (!built->ok) return state.SkipWithError("the network does not load");
  CropRegion(Footage()[0].view(), FaceRegion(), built->network.input());
  auto out = std::make_unique<CropLandmarks>();
  for (auto _ : state) benchmark::DoNotOptimize(built->network.Run(*out));
  if (out->presence < 0.5F) state.SkipWithError("no face in the crop");
}
void BM_MeshNetwork(benchmark::State& state) { RunLandmarks<MeshNetwork>(state, Model::kMesh); }
void BM_AttentionNetwork(benchmark::State& state) {
  RunLandmarks<AttentionNetwork>(state, Model::kAttention);
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

void Settings(benchmark::internal::Benchmark* b) {
  b->MeasureProcessCPUTime()
      ->Unit(benchmark::kMicrosecond)
      ->Repetitions(9)
      ->MinTime(0.1)
      ->DisplayAggregatesOnly();
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
