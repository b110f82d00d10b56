#include "core/track/tracker.h"

#include <algorithm>

#include "core/track/crop.h"
#include "core/track/network_memory.h"
#include "core/track/tflite_model.h"

namespace facewire::track {
namespace {

constexpr std::size_t kAlignment = 64;

// Measured: see README.md, "Memory". Processors differ in how they pack weights, so both figures
// have some room.
constexpr std::size_t kMeshBytes = std::size_t{16} << 20;
constexpr std::size_t kAttentionBytes = std::size_t{21} << 20;

constexpr std::size_t BlockBytes(Model model) noexcept {
  return model == Model::kAttention ? kAttentionBytes : kMeshBytes;
}

bool IsFraction(float v) noexcept { return v >= 0.0F && v <= 1.0F; }

}  // namespace

std::size_t Tracker::RequiredBytes(Model model) noexcept {
  return BlockBytes(model) + kAlignment - 1;  // the arena's next free byte may lie anywhere
}

Result<> Tracker::Load(const TrackerConfig& config, const NetworkFiles& files,
                       Arena& arena) noexcept {
  if (loaded_ || !IsFraction(config.min_detection_score) || !IsFraction(config.min_presence)) {
    return Errc::kInvalidArgument;
  }
  const std::size_t bytes = BlockBytes(config.model);
  auto* block = static_cast<std::byte*>(arena.Allocate(bytes, kAlignment));
  if (block == nullptr) return Errc::kFull;
  if (auto started = NetworkMemory::StartXnnpack(); !started) return started;
  NetworkMemory memory({block, bytes});
  config_ = config;
  if (auto built = BuildNetworks(files, memory); !built) return built;
  loaded_ = true;
  return {};
}

Result<> Tracker::BuildNetworks(const NetworkFiles& files, NetworkMemory& memory) noexcept {
  const auto detector = TfliteModel::Parse(files.detector);
  if (!detector) return detector.error();
  const auto landmarks = TfliteModel::Parse(files.landmarks);
  if (!landmarks) return landmarks.error();
  if (auto built = detector_.Build(*detector, memory); !built) return built;
  return config_.model == Model::kAttention ? attention_.Build(*landmarks, memory)
                                            : mesh_.Build(*landmarks, memory);
}

Result<Landmarks> Tracker::Update(const Frame& frame) noexcept {
  if (!loaded_) return Errc::kNotReady;
  if (auto checked = CheckImage(frame.image); !checked) return checked.error();
  if (!region_) {
    const auto found = detector_.Detect(frame.image, config_.min_detection_score);
    if (!found) return found.error();
    region_ = RegionOf(*found);
  }
  const Region region = *region_;
  region_.reset();  // unless everything below goes well
  if (!IsUsable(region)) return Errc::kNoFace;

  const bool attention = config_.model == Model::kAttention;
  CropRegion(frame.image, region, attention ? attention_.input() : mesh_.input());
  if (auto run = attention ? attention_.Run(in_crop_) : mesh_.Run(in_crop_); !run)
    return run.error();
  if (!(in_crop_.presence >= config_.min_presence)) return Errc::kNoFace;

  Landmarks out;
  out.seq = frame.seq;
  out.captured = frame.captured;
  out.width_px = frame.image.width_px;
  out.height_px = frame.image.height_px;
  out.presence = in_crop_.presence;
  out.count = in_crop_.count;
  std::transform(in_crop_.points.begin(), in_crop_.points.begin() + out.count,
                 out.points_px.begin(), CropToPicture(region, static_cast<float>(kLandmarkSize)));
  const Region next = RegionOf(std::span(out.points_px).first(out.count));
  if (!IsUsable(next)) return Errc::kNoFace;
  region_ = next;
  return out;
}

void Tracker::Reset() noexcept { region_.reset(); }

}  // namespace facewire::track
