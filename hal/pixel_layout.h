#ifndef FACEWIRE_HAL_PIXEL_LAYOUT_H_
#define FACEWIRE_HAL_PIXEL_LAYOUT_H_

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/base/result.h"
#include "core/frame.h"

namespace facewire::hal {

// Where the planes of a picture lie in one buffer of a device.
struct PixelLayout {
  ImageView view;  // without pixels: planes[].data is nullptr
  std::array<std::size_t, 3> plane_offsets{};
  std::size_t bytes = 0;  // from the buffer's start to the end of the last row

  ImageView At(const std::uint8_t* buffer) const noexcept;
};

// `stride_bytes` is the device's bytesperline, that of the first plane; 0 means packed.
// kUnsupported: the size is impossible for the format (odd, zero), or the stride is shorter than a
// row.
Result<PixelLayout> LayOut(PixelFormat format, int width_px, int height_px,
                           std::uint32_t stride_bytes) noexcept;

}  // namespace facewire::hal

#endif  // FACEWIRE_HAL_PIXEL_LAYOUT_H_
