// What the whole frame costs, from a picture to bytes for the line, beside the bare attention
// network in the same run. tests/bench/ratio prints the one over the other.
#include <benchmark/benchmark.h>

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "app/networks.h"
#include "app/profile_file.h"
#include "app/rig_file.h"
#include "core/frame_path/frame_path.h"
#include "core/frame_path/motion.h"
#include "core/wire/encoder.h"
#include "core/wire/pose.h"
#include "core/wire/rig_description.h"
#include "tests/bench/networks.h"

namespace facewire::bench {
namespace {

constexpr Duration kFramePeriod{1'000'000 / 24};  // of the footage, which has 24 frames a second

// Every stage as the service has it, with the shipped profile and character.
class Frames {
 public:
  Frames() {
    const app::Networks networks =
        app::LoadNetworks(FACEWIRE_ASSETS "/networks", track::Model::kAttention);
    std::vector<std::string> signals;
    for (const ShortName& name : profile_->mapping().signals()) signals.emplace_back(name.view());
    rig_ = app::LoadRig(FACEWIRE_SOURCE_DIR "/app/share/otto.toml", &signals);
    rig_id_ = wire::RigId(rig_);
    ok_ = path_.Load(networks.files(), arena_) &&
          retargeter_.Configure(rig_, &profile_->mapping(), arena_) &&
          motion_.Configure(rig_, {}, Time{});
    path_.Use(retargeter_);
    // A performer with a neutral costs more than the average face does without.
    for (int i = 0; i < kFrames && ok_; ++i) {
      const Result<Followed> followed = Follow();
      ok_ = followed && (i > 0 || retargeter_.SetNeutral(NeutralOf(followed->face)));
      Send(followed);
    }
  }

  bool ok() const { return ok_ && motion_.state() == ServiceState::kTracking; }

  Result<Followed> Follow() {
    ++seq_;
    Frame frame = Footage()[PingPong(seq_)].frame(seq_);
    frame.captured = now_ += kFramePeriod;
    return path_.Update(frame);
  }
  // The number of bytes for the line.
  std::size_t Send(const Result<Followed>& followed) {
    const MotionOutput out = motion_.Update({.now = now_, .sight = SightOf(followed)},
                                            followed ? followed->rig : RigPose{});
    const auto bytes =
        encoder_.Encode(wire::MakePose(rig_, rig_id_, out.pose, out.state, now_), bytes_);
    return bytes ? bytes->size() : 0;
  }

 private:
  static retarget::Neutral NeutralOf(const FacePose& face) {
    return {.count = face.count,
            .points_cm = face.points_cm,
            .camera_R_head = face.camera_R_head,
            .camera_t_head_cm = face.camera_t_head_cm};
  }

  std::unique_ptr<app::Profile> profile_ =
      app::LoadProfile(FACEWIRE_SOURCE_DIR "/app/share/average.profile");
  std::vector<std::byte> memory_ =
      std::vector<std::byte>(FramePath::RequiredBytes(track::Model::kAttention) +
                             retarget::Retargeter::RequiredBytes() + 256);
  Arena arena_{memory_};
  FramePath path_{FramePathConfig{}};
  retarget::Retargeter retargeter_;
  Rig rig_;
  std::uint32_t rig_id_ = 0;
  Motion motion_;
  wire::Encoder encoder_;
  std::array<std::byte, wire::kMaxPoseFrameBytes> bytes_{};
  Time now_{};
  std::uint64_t seq_ = 0;
  bool ok_ = false;
};

void BM_Frame(benchmark::State& state) {
  const auto frames = std::make_unique<Frames>();
  if (!frames->ok()) return state.SkipWithError("the face is not followed");
  for (auto _ : state) {
    const Result<Followed> followed = frames->Follow();
    if (!followed) return state.SkipWithError("the face is lost");
    benchmark::DoNotOptimize(frames->Send(followed));
  }
}

BENCHMARK(BM_AttentionNetwork)->Apply(Settings);
BENCHMARK(BM_Frame)->Apply(Settings);

}  // namespace
}  // namespace facewire::bench
