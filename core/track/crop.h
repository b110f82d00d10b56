#ifndef FACEWIRE_CORE_TRACK_CROP_H_
#define FACEWIRE_CORE_TRACK_CROP_H_

#include <span>

#include "core/base/result.h"
#include "core/frame.h"
#include "core/track/region.h"

namespace facewire::track {

// Sampling straight from a camera's pixels into a network's input: size x size pixels of R, G, B as
// floats. Each output pixel is one bilinear sample at its centre; YUV is taken to RGB per sample
// (the chroma of a pixel is that of its 2x1 or 2x2 block, as cameras deliver it).

inline constexpr int kDetectorSize = 128;
inline constexpr int kLandmarkSize = 192;

// Whether the crops below may touch the picture. kUnsupported: a format that is not in PixelFormat,
// or fewer than 2x2 pixels. kInvalidArgument: a plane without pixels, or with rows shorter than the
// picture.
Result<> CheckImage(const ImageView& image) noexcept;

// The whole picture, centred in a square of its longer side, in -1..1; outside the picture is
// black. `out` holds 3 * kDetectorSize^2 floats. The image has passed CheckImage.
void CropLetterbox(const ImageView& image, std::span<float> out) noexcept;

// The region, upright, in 0..1; outside the picture its outermost pixels go on. `out` holds
// 3 * kLandmarkSize^2 floats. The image has passed CheckImage; any region is safe.
void CropRegion(const ImageView& image, const Region& region, std::span<float> out) noexcept;

}  // namespace facewire::track

#endif  // FACEWIRE_CORE_TRACK_CROP_H_
