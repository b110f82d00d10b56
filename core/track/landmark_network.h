#ifndef FACEWIRE_CORE_TRACK_LANDMARK_NETWORK_H_
#define FACEWIRE_CORE_TRACK_LANDMARK_NETWORK_H_

#include <array>
#include <cstddef>
#include <span>

#include "core/base/capacity.h"
#include "core/base/geometry.h"
#include "core/base/result.h"
#include "core/track/attention_ops.h"
#include "core/track/custom_options.h"
#include "core/track/network_memory.h"
#include "core/track/tflite_model.h"
#include "core/track/xnn_network.h"

namespace facewire::track {

// What a landmark network makes of a crop, in pixels of the crop.
struct CropLandmarks {
  float presence = 0;     // 0..1
  std::size_t count = 0;  // kMeshLandmarks or kMaxLandmarks
  std::array<Point3, kMaxLandmarks> points;
};

// face_landmark.tflite: one pass, kMeshLandmarks points.
class MeshNetwork {
 public:
  // kCorrupt (not this network), kFull, kUnsupported.
  Result<> Build(const TfliteModel& model, NetworkMemory& memory) noexcept;
  // kLandmarkSize x kLandmarkSize x RGB, 0..1.
  std::span<float> input() noexcept { return network_.input(0); }
  // Allocates nothing. kNotReady before Build.
  Result<> Run(CropLandmarks& out) noexcept;

 private:
  XnnNetwork network_;
};

// face_landmark_with_attention.tflite: the mesh first, then lips and eyes once more in cuts of the
// mesh's feature map. Lips and eyes get their refined x and y; five points of each iris are added,
// whose z is the mean of the eye's contour. kMaxLandmarks points.
class AttentionNetwork {
 public:
  Result<> Build(const TfliteModel& model, NetworkMemory& memory) noexcept;
  std::span<float> input() noexcept { return mesh_.input(0); }
  Result<> Run(CropLandmarks& out) noexcept;

 private:
  static constexpr std::size_t kParts = 3;  // lips, image-left eye, image-right eye

  XnnNetwork mesh_;   // the crop -> features, mesh, presence
  XnnNetwork parts_;  // three cuts -> refined points of each, and the irises
  std::array<PartOptions, kParts> options_{};
  FeatureMap features_;
};

}  // namespace facewire::track

#endif  // FACEWIRE_CORE_TRACK_LANDMARK_NETWORK_H_
