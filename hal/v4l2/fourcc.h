#ifndef FACEWIRE_HAL_V4L2_FOURCC_H_
#define FACEWIRE_HAL_V4L2_FOURCC_H_

#include <array>
#include <cstdint>
#include <optional>

#include "hal/camera_format.h"

namespace facewire::hal::v4l2 {

// V4L2's code of a format (V4L2_PIX_FMT_...), and back; nullopt for formats that facewire does not
// read.
std::uint32_t FourccOf(CameraFormat format) noexcept;
std::optional<CameraFormat> FormatOf(std::uint32_t fourcc) noexcept;

// "YUYV": a format's code in the letters that v4l2-ctl shows, unprintable ones as '?'.
std::array<char, 5> FourccText(std::uint32_t fourcc) noexcept;

}  // namespace facewire::hal::v4l2

#endif  // FACEWIRE_HAL_V4L2_FOURCC_H_
