#ifndef FACEWIRE_CORE_FILTER_REGIONS_H_
#define FACEWIRE_CORE_FILTER_REGIONS_H_

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/base/capacity.h"

namespace facewire::filter {

// Parts of the face that move at different speeds.
enum class Region : std::uint8_t { kRest, kEyes, kMouth };

// Landmarks of MediaPipe's face mesh topology (left and right as seen in the picture).
// The lids' edges and the ring of skin around them that moves with a blink.
inline constexpr std::array<std::uint16_t, 64> kLidLandmarks = {
    33,  7,   163, 144, 145, 153, 154, 155, 133, 246, 161, 160, 159, 158, 157, 173,   // left edge
    130, 25,  110, 24,  23,  22,  26,  112, 243, 247, 30,  29,  27,  28,  56,  190,   // left ring
    263, 249, 390, 373, 374, 380, 381, 382, 362, 466, 388, 387, 386, 385, 384, 398,   // right edge
    359, 255, 339, 254, 253, 252, 256, 341, 463, 467, 260, 259, 257, 258, 286, 414};  // right ring
// Pupil and rim of both irises, which only the attention network delivers.
inline constexpr std::array<std::uint16_t, 10> kIrisLandmarks = {468, 469, 470, 471, 472,
                                                                 473, 474, 475, 476, 477};
// The 80 points of the lips: four rings from the outer edge to the inner one, lower half before
// upper half.
inline constexpr std::array<std::uint16_t, 80> kLipLandmarks = {
    61, 146, 91, 181, 84, 17, 314, 405, 321, 375, 291, 185, 40, 39, 37, 0,  267, 269, 270, 409,
    76, 77,  90, 180, 85, 16, 315, 404, 320, 307, 306, 184, 74, 73, 72, 11, 302, 303, 304, 408,
    62, 96,  89, 179, 86, 15, 316, 403, 319, 325, 292, 183, 42, 41, 38, 12, 268, 271, 272, 407,
    78, 95,  88, 178, 87, 14, 317, 402, 318, 324, 308, 191, 80, 81, 82, 13, 312, 311, 310, 415};

constexpr std::array<Region, kMaxLandmarks> MakeRegionTable() noexcept {
  std::array<Region, kMaxLandmarks> table{};
  for (std::uint16_t i : kLidLandmarks) table[i] = Region::kEyes;
  for (std::uint16_t i : kIrisLandmarks) table[i] = Region::kEyes;
  for (std::uint16_t i : kLipLandmarks) table[i] = Region::kMouth;
  return table;
}
// By landmark.
inline constexpr std::array<Region, kMaxLandmarks> kRegionOf = MakeRegionTable();

}  // namespace facewire::filter

#endif  // FACEWIRE_CORE_FILTER_REGIONS_H_
