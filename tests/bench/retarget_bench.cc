#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "app/profile_file.h"
#include "app/rig_file.h"
#include "core/retarget/retargeter.h"

namespace facewire {
namespace {

constexpr const char* kProfile = FACEWIRE_SOURCE_DIR "/app/share/average.profile";

// A performer's own profile: a dozen poses of the default one.
std::unique_ptr<app::Profile> PersonalProfile() {
  app::TrainingSet training = app::ReadTrainingSet(kProfile);
  constexpr std::size_t kPoses = 12;
  const std::size_t step = training.view().sample_count() / kPoses;
  const auto thin = [step](std::vector<float>& values, std::size_t row) {
    for (std::size_t pose = 0; pose < kPoses; ++pose)
      std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(pose * step * row), row,
                  values.begin() + static_cast<std::ptrdiff_t>(pose * row));
    values.resize(kPoses * row);
  };
  thin(training.samples, 3 * training.markers.size());
  thin(training.targets, training.signals.size());
  training.neutral_sample = 0;
  return std::make_unique<app::Profile>(training, "personal");
}

// The default profile on the face it was trained on, wobbling a little, with or without a personal
// profile; the default character.
struct Subject {
  std::unique_ptr<app::Profile> profile = app::LoadProfile(kProfile);
  std::unique_ptr<app::Profile> personal;
  Rig rig = app::LoadRig(FACEWIRE_SOURCE_DIR "/app/share/otto.toml");
  std::vector<std::byte> block = std::vector<std::byte>(retarget::Retargeter::RequiredBytes());
  std::unique_ptr<retarget::Retargeter> retargeter = std::make_unique<retarget::Retargeter>();
  std::unique_ptr<FacePose> face = std::make_unique<FacePose>();

  explicit Subject(bool with_personal = false) {
    if (with_personal) personal = PersonalProfile();
    Arena arena(block);
    if (!retargeter->Configure(rig, &profile->mapping(), arena,
                               with_personal ? &personal->mapping() : nullptr))
      std::abort();
    face->count = kMaxLandmarks;
    // Landmarks that the profile does not read lie anywhere, but not in one place.
    for (std::size_t i = 0; i < face->count; ++i)
      face->points_cm[i] = {static_cast<float>(i % 20), static_cast<float>(i / 20), 0};
    const auto indices = profile->mapping().point_indices();
    for (std::size_t i = 0; i < indices.size(); ++i)
      face->points_cm[indices[i]] = profile->mapping().neutral_cm()[i];
  }
  retarget::Neutral Neutral() const {
    return {face->count, face->points_cm, face->camera_R_head, face->camera_t_head_cm};
  }
};

void Update(benchmark::State& state, bool with_personal) {
  Subject subject(with_personal);
  subject.retargeter->SetBlend(0.5F);
  if (!subject.retargeter->SetNeutral(subject.Neutral())) state.SkipWithError("neutral");
  float t = 0;
  for (auto _ : state) {
    subject.face->points_cm[386].y += 0.1F * std::sin(t += 0.1F);
    benchmark::DoNotOptimize(subject.retargeter->Update(*subject.face));
  }
}

void RetargeterUpdate(benchmark::State& state) { Update(state, false); }
BENCHMARK(RetargeterUpdate)->Unit(benchmark::kMicrosecond);

// The budget: at most 60 us.
void RetargeterUpdateWithPersonalProfile(benchmark::State& state) { Update(state, true); }
BENCHMARK(RetargeterUpdateWithPersonalProfile)->Unit(benchmark::kMicrosecond);

void RetargeterSetNeutral(benchmark::State& state) {
  Subject subject;
  const auto neutral = subject.Neutral();
  for (auto _ : state)
    if (!subject.retargeter->SetNeutral(neutral)) state.SkipWithError("neutral");
}
BENCHMARK(RetargeterSetNeutral)->Unit(benchmark::kMillisecond);

void LoadDefaultProfile(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(app::LoadProfile(kProfile));
}
BENCHMARK(LoadDefaultProfile)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace facewire
