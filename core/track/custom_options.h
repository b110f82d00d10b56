#ifndef FACEWIRE_CORE_TRACK_CUSTOM_OPTIONS_H_
#define FACEWIRE_CORE_TRACK_CUSTOM_OPTIONS_H_

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/base/capacity.h"
#include "core/base/inline_vector.h"
#include "core/base/result.h"

namespace facewire::track {

// Most landmarks that one refined part of the face (lips, an eye) has.
inline constexpr std::size_t kMaxSubset = 80;

// The options of Landmarks2TransformMatrix, version 2: which part of the face is cut out of a
// feature map, and how.
struct PartOptions {
  InlineVector<std::uint16_t, kMaxSubset> subset;  // mesh points of the part, each < kMeshLandmarks
  int left_rotation = 0;                           // mesh points on the part's horizontal axis
  int right_rotation = 0;
  int output_width = 0;  // of the cut, in features
  int output_height = 0;
  float scale_x = 0;  // size of the cut against the box around the subset
  float scale_y = 0;
};

// Reads the flexbuffer of such an operator. kCorrupt when it is none, or has a value out of range.
Result<PartOptions> ReadPartOptions(std::span<const std::byte> flexbuffer) noexcept;

}  // namespace facewire::track

#endif  // FACEWIRE_CORE_TRACK_CUSTOM_OPTIONS_H_
