#ifndef FACEWIRE_CORE_TRACK_FACE_DETECTOR_H_
#define FACEWIRE_CORE_TRACK_FACE_DETECTOR_H_

#include <array>
#include <cstddef>
#include <span>

#include "core/base/result.h"
#include "core/frame.h"
#include "core/track/network_memory.h"
#include "core/track/region.h"
#include "core/track/tflite_model.h"
#include "core/track/xnn_network.h"

namespace facewire::track {

// The detector's output: candidates of two grids of cells, a few at each cell.
inline constexpr std::size_t kAnchors = 896;    // 16 x 16 x 2, then 8 x 8 x 6
inline constexpr std::size_t kBoxNumbers = 16;  // cx, cy, w, h, then x, y of six keypoints

struct Anchor {
  float x = 0, y = 0;  // centre, as a fraction of the network's input
};
using Anchors = std::array<Anchor, kAnchors>;

// The cells' centres, row by row, each as often as the cell has candidates
// (mediapipe face_detection_short_range: strides 8, 16, 16, 16, fixed anchor size).
Anchors MakeAnchors() noexcept;

// What the network says, before it is decoded.
struct RawDetections {
  std::span<const float, kAnchors> scores;               // logits
  std::span<const float, kAnchors * kBoxNumbers> boxes;  // in pixels of the input, from the anchor
};

// The best face: the candidate with the highest score, averaged (weighted by score) with those that
// overlap it by more than 0.3 of their union. Positions are fractions of the network's input.
// kNoFace when no score reaches min_score (0..1).
Result<Detection> DecodeBest(const RawDetections& raw, const Anchors& anchors,
                             float min_score) noexcept;

// Finds a face anywhere in a picture (as long as it takes up about a fifth of it or more).
class FaceDetector {
 public:
  // kCorrupt (not this network), kFull, kUnsupported.
  Result<> Build(const TfliteModel& model, NetworkMemory& memory) noexcept;

  // In pixels of the image, which has passed CheckImage. kNoFace; kNotReady before Build.
  Result<Detection> Detect(const ImageView& image, float min_score) noexcept;

 private:
  XnnNetwork network_;
  Anchors anchors_{};
  std::array<float, kAnchors> scores_{};
  std::array<float, kAnchors * kBoxNumbers> boxes_{};
};

}  // namespace facewire::track

#endif  // FACEWIRE_CORE_TRACK_FACE_DETECTOR_H_
