#ifndef FACEWIRE_CORE_WIRE_LANDMARK_PART_H_
#define FACEWIRE_CORE_WIRE_LANDMARK_PART_H_

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "core/base/inline_vector.h"
#include "core/base/time.h"
#include "core/landmarks.h"

namespace facewire::wire {

// In eighths of a pixel of the picture: x right, y down, (0,0) its top-left corner. So -4096 to
// 4095.875 pixels, which is more than any picture that facewire takes (4096 wide), to 1/8 pixel,
// which is less than the landmarks tremble.
struct LandmarkPoint {
  std::int16_t x_eighth_px = 0;
  std::int16_t y_eighth_px = 0;
};

// Part of the landmarks of one picture, short enough to pass between two poses on a slow line: 15
// of them tell all 478. A host has a picture when it has points 0 to total - 1 of one frame_seq.
inline constexpr std::size_t kMaxLandmarksInPart = 32;
struct LandmarkPart {
  std::uint32_t frame_seq = 0;  // of Landmarks::seq the low 32 bits; a Pose repeats it
  Time captured{};              // on the device's clock
  std::uint16_t width_px = 0;   // of the picture
  std::uint16_t height_px = 0;
  std::uint16_t total = 0;  // landmarks of this picture, 0..kMaxLandmarks; 0: it shows no face
  std::uint16_t first = 0;  // index of points[0]; first + points.size() <= total
  InlineVector<LandmarkPoint, kMaxLandmarksInPart> points{};
};
static_assert(std::is_trivially_copyable_v<LandmarkPart>);

constexpr bool IsValid(const LandmarkPart& part) noexcept {
  return part.total <= kMaxLandmarks && part.first + part.points.size() <= part.total;
}

constexpr std::size_t LandmarkPartPayloadBytes(std::size_t points) noexcept {
  return 21 + 4 * points;
}

// The part that begins with landmark `first`, as many points as there are and fit. What lies beyond
// the numbers' range is sent as its end, and what is not a number as 0. Unmirrored, as Landmarks.
LandmarkPart PartOf(const Landmarks& landmarks, std::size_t first) noexcept;

}  // namespace facewire::wire

#endif  // FACEWIRE_CORE_WIRE_LANDMARK_PART_H_
