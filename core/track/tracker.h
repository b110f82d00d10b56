#ifndef FACEWIRE_CORE_TRACK_TRACKER_H_
#define FACEWIRE_CORE_TRACK_TRACKER_H_

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "core/base/arena.h"
#include "core/base/result.h"
#include "core/frame.h"
#include "core/landmarks.h"
#include "core/track/face_detector.h"
#include "core/track/landmark_network.h"
#include "core/track/region.h"

namespace facewire::track {

enum class Model : std::uint8_t {
  kAttention,  // 478 points, exact lids, lips and irises
  kMesh,       // 468 points, about a fifth cheaper
};

struct TrackerConfig {
  Model model = Model::kAttention;
  float min_detection_score = 0.5F;  // of the detector, 0..1
  float min_presence = 0.5F;  // of the landmark network, 0..1; below it the face counts as lost
};

// The contents of the .tflite files (checked by whoever read them), each starting at a multiple of
// eight bytes, as vectors do. Borrowed during Load only.
struct NetworkFiles {
  std::span<const std::byte> detector;  // face_detection_short_range
  std::span<const std::byte>
      landmarks;  // face_landmark_with_attention or face_landmark, as the model says
};

class Tracker {
 public:
  Tracker() noexcept = default;
  Tracker(const Tracker&) = delete;
  Tracker& operator=(const Tracker&) = delete;

  // Bytes of arena that Load needs for the model.
  static std::size_t RequiredBytes(Model model) noexcept;

  // Builds the networks in the arena, which must outlive the tracker. Once per tracker.
  // kCorrupt (not these networks), kFull (arena too small), kUnsupported (processor),
  // kInvalidArgument (a threshold outside 0..1, or loaded already).
  Result<> Load(const TrackerConfig& config, const NetworkFiles& files, Arena& arena) noexcept;

  // Finds or follows the face. Allocates nothing. kNoFace; kUnsupported (pixel format, fewer than
  // 2x2 pixels); kInvalidArgument (a plane without pixels or with too short rows); kNotReady before
  // Load. The detector runs only while there is no face to follow, so a frame in which the face is
  // lost gives kNoFace and the next one looks for it anew: no frame costs more than both networks.
  Result<Landmarks> Update(const Frame& frame) noexcept;

  // Forgets where the face was: the next Update runs the detector.
  void Reset() noexcept;

 private:
  Result<> BuildNetworks(const NetworkFiles& files, NetworkMemory& memory) noexcept;

  TrackerConfig config_;
  FaceDetector detector_;
  MeshNetwork mesh_;  // one of these two, as the configuration says
  AttentionNetwork attention_;
  bool loaded_ = false;
  std::optional<Region> region_;  // where the face is expected
  CropLandmarks in_crop_;
};

}  // namespace facewire::track

#endif  // FACEWIRE_CORE_TRACK_TRACKER_H_
