// What a frame costs after the tracker: from 478 landmarks in pixels to bytes for the line, with
// the shipped profile and a character of 20 bones that follow landmarks and all shapes of the
// profile.
#include <benchmark/benchmark.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "app/profile_file.h"
#include "app/rig_file.h"
#include "core/filter/landmark_filter.h"
#include "core/frame_path/motion.h"
#include "core/pose/pose_estimator.h"
#include "core/retarget/retargeter.h"
#include "core/wire/encoder.h"
#include "core/wire/pose.h"
#include "core/wire/rig_description.h"
#include "tests/support/generated_face.h"

namespace facewire {
namespace {

constexpr std::size_t kBones = 20;
constexpr std::size_t kApart = 23;  // from one bone's landmark to the next: all over the face
constexpr Duration kFramePeriod{33'333};

// With the bones where the performer's landmarks are, and every shape from 0 to 1.
Rig MakeRig(const FacePose& face, const retarget::ExpressionMapping& mapping) {
  const auto path = std::filesystem::temp_directory_path() /
                    ("facewire-bench-" + std::to_string(getpid()) + ".toml");
  std::ofstream out(path);
  out << "name = \"bench\"\n";
  for (std::size_t b = 0; b < kBones; ++b) {
    const Point3 rest = face.points_cm[b * kApart];
    out << "[[bone]]\nname = \"bone" << b << "\"\nlandmark = " << b * kApart << "\nrest_cm = ["
        << rest.x << ", " << rest.y << ", " << rest.z << "]\n";
    for (const char axis : {'x', 'y', 'z'})
      out << axis << " = { min = -2, max = 2, max_speed = 50, max_acceleration = 1000 }\n";
  }
  for (const ShortName& shape : mapping.signals())
    out << "[[parameter]]\nname = \"" << shape.view() << "\"\nmax_speed = 25\n";
  out.close();
  Rig rig = app::LoadRig(path);
  std::filesystem::remove(path);
  return rig;
}

class Stages {
 public:
  Stages() {
    const auto first = See();
    if (!first) return;
    rig_ = MakeRig(*first, profile_->mapping());
    rig_id_ = wire::RigId(rig_);
    ok_ = retargeter_.Configure(rig_, &profile_->mapping(), arena_) &&
          motion_.Configure(rig_, {}, Time{}) &&
          retargeter_.SetNeutral({.count = first->count,
                                  .points_cm = first->points_cm,
                                  .camera_R_head = first->camera_R_head,
                                  .camera_t_head_cm = first->camera_t_head_cm});
    // Until the motion has ramped up to the face.
    for (int i = 0; i < 100 && ok_; ++i) ok_ = Frame() > 0;
  }

  bool ok() const { return ok_ && motion_.state() == ServiceState::kTracking; }

  // One frame, all stages; the number of bytes for the line.
  std::size_t Frame() {
    const auto face = See();
    if (!face) return 0;
    const MotionOutput out = motion_.Update(
        {.now = landmarks_.captured, .sight = state::Sight::kFace}, retargeter_.Update(*face));
    const auto bytes = encoder_.Encode(
        wire::MakePose(rig_, rig_id_, out.pose, out.state, landmarks_.captured), bytes_);
    return bytes ? bytes->size() : 0;
  }

 private:
  // The face sways by a pixel.
  Result<FacePose> See() {
    ++landmarks_.seq;
    landmarks_.captured += kFramePeriod;
    sway_px_ = -sway_px_;
    for (Point3& p : landmarks_.points_px) p.x += sway_px_;
    const auto steady = filter_.Update(landmarks_);
    if (!steady) return steady.error();
    return pose_.Update(*steady);
  }

  std::unique_ptr<app::Profile> profile_ =
      app::LoadProfile(FACEWIRE_SOURCE_DIR "/app/share/average.profile");
  std::vector<std::byte> memory_ =
      std::vector<std::byte>(retarget::Retargeter::RequiredBytes() + 256);
  Arena arena_{memory_};
  Landmarks landmarks_ = test::Photograph(test::GeneratedFace(), {});
  float sway_px_ = 1;
  filter::LandmarkFilter filter_{filter::FilterConfig{}};
  pose::PoseEstimator pose_{pose::PoseConfig{}};
  retarget::Retargeter retargeter_;
  Rig rig_;
  std::uint32_t rig_id_ = 0;
  Motion motion_;
  wire::Encoder encoder_;
  std::array<std::byte, wire::kMaxPoseFrameBytes> bytes_{};
  bool ok_ = false;
};

void AfterTracker(benchmark::State& state) {
  const auto stages = std::make_unique<Stages>();
  if (!stages->ok()) return state.SkipWithError("the face is not followed");
  for (auto _ : state)
    if (stages->Frame() == 0) return state.SkipWithError("the face is lost");
}
BENCHMARK(AfterTracker)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace facewire
