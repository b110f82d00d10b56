#include <benchmark/benchmark.h>

#include <cmath>
#include <memory>
#include <vector>

#include "app/profile_file.h"
#include "core/retarget/retargeter.h"

namespace facewire {
namespace {

// The default profile on the face it was trained on, wobbling a little.
struct Subject {
  std::unique_ptr<app::Profile> profile =
      app::LoadProfile(FACEWIRE_SOURCE_DIR "/app/share/average.profile");
  Rig rig;
  std::vector<std::byte> block = std::vector<std::byte>(retarget::Retargeter::RequiredBytes());
  std::unique_ptr<retarget::Retargeter> retargeter = std::make_unique<retarget::Retargeter>();
  std::unique_ptr<FacePose> face = std::make_unique<FacePose>();

  Subject() {
    Arena arena(block);
    if (!retargeter->Configure(rig, &profile->mapping(), arena)) std::abort();
    face->count = kMaxLandmarks;
    const auto indices = profile->mapping().point_indices();
    for (std::size_t i = 0; i < indices.size(); ++i)
      face->points_cm[indices[i]] = profile->mapping().neutral_cm()[i];
  }
  retarget::Neutral Neutral() const {
    return {face->count, face->points_cm, face->camera_R_head, face->camera_t_head_cm};
  }
};

void RetargeterUpdate(benchmark::State& state) {
  Subject subject;
  if (!subject.retargeter->SetNeutral(subject.Neutral())) state.SkipWithError("neutral");
  float t = 0;
  for (auto _ : state) {
    subject.face->points_cm[386].y += 0.1F * std::sin(t += 0.1F);
    benchmark::DoNotOptimize(subject.retargeter->Update(*subject.face));
  }
}
BENCHMARK(RetargeterUpdate)->Unit(benchmark::kMicrosecond);

void RetargeterSetNeutral(benchmark::State& state) {
  Subject subject;
  const auto neutral = subject.Neutral();
  for (auto _ : state)
    if (!subject.retargeter->SetNeutral(neutral)) state.SkipWithError("neutral");
}
BENCHMARK(RetargeterSetNeutral)->Unit(benchmark::kMillisecond);

void LoadDefaultProfile(benchmark::State& state) {
  for (auto _ : state)
    benchmark::DoNotOptimize(app::LoadProfile(FACEWIRE_SOURCE_DIR "/app/share/average.profile"));
}
BENCHMARK(LoadDefaultProfile)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace facewire
