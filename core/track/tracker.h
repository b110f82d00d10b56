#ifndef FACEWIRE_CORE_TRACK_TRACKER_H_
#define FACEWIRE_CORE_TRACK_TRACKER_H_

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/base/arena.h"
#include "core/base/result.h"
#include "core/frame.h"
#include "core/landmarks.h"

namespace facewire::track {

enum class Model : std::uint8_t {
  kAttention,  // 478 points, exact lids, lips and irises
  kMesh,       // 468 points, about a fifth cheaper
};

struct TrackerConfig {
  Model model = Model::kAttention;
  float min_detection_score = 0.5F;  // of the detector, 0..1
  float min_presence = 0.5F;         // of the landmark network, 0..1; below it the face counts as lost
};

// The contents of the .tflite files (checked by whoever read them). Borrowed during Load only.
struct NetworkFiles {
  std::span<const std::byte> detector;   // face_detection_short_range
  std::span<const std::byte> landmarks;  // face_landmark_with_attention or face_landmark, as the model says
};

class Tracker {
 public:
  Tracker() noexcept = default;
  Tracker(const Tracker&) = delete;
  Tracker& operator=(const Tracker&) = delete;

  // Bytes of arena that Load needs for the model.
  static std::size_t RequiredBytes(Model model) noexcept;

  // Builds the networks in the arena, which must outlive the tracker. Once per tracker.
  // kCorrupt (not these networks), kFull (arena too small), kUnsupported (processor).
  Result<> Load(const TrackerConfig& config, const NetworkFiles& files, Arena& arena) noexcept;

  // Finds or follows the face. Allocates nothing. kNoFace; kUnsupported (pixel format, size 0).
  Result<Landmarks> Update(const Frame& frame) noexcept;

  // Forgets where the face was: the next Update runs the detector.
  void Reset() noexcept;
};

}  // namespace facewire::track

#endif  // FACEWIRE_CORE_TRACK_TRACKER_H_
