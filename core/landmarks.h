#ifndef FACEWIRE_CORE_LANDMARKS_H_
#define FACEWIRE_CORE_LANDMARKS_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "core/base/capacity.h"
#include "core/base/geometry.h"
#include "core/base/time.h"

namespace facewire {

// Further from the origin lies no picture; a coordinate beyond it is an accident.
inline constexpr float kMaxCoordinatePx = 1e6F;

// A face as the networks see it. Points in MediaPipe's face mesh order (468 mesh points, then with
// the attention network 5 points of the image-left iris and 5 of the image-right one).
// Pixels of the frame: x right, y down, (0,0) the top-left corner of the picture and (0.5,0.5) the
// centre of its first pixel; z in the same unit, relative to the head, smaller = nearer to the
// camera.
struct Landmarks {
  std::uint64_t seq = 0;  // of the frame
  Time captured{};        // of the frame
  int width_px = 0;       // of the frame
  int height_px = 0;
  float presence = 0;     // the network's probability that this is a face, 0..1
  std::size_t count = 0;  // kMaxLandmarks (attention) or kMeshLandmarks (mesh)
  std::array<Point3, kMaxLandmarks> points_px{};
};
static_assert(std::is_trivially_copyable_v<Landmarks>);

}  // namespace facewire

#endif  // FACEWIRE_CORE_LANDMARKS_H_
