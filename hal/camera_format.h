#ifndef FACEWIRE_HAL_CAMERA_FORMAT_H_
#define FACEWIRE_HAL_CAMERA_FORMAT_H_

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "core/frame.h"

namespace facewire::hal {

// In what form a live camera sends its pictures.
enum class CameraFormat : std::uint8_t {
  kYuyv,
  kNv12,
  kI420,
  kRgb24,
  kBgr24,
  kMjpeg,  // compressed; frames come out of it as kRgb24
  kGrey8,
};

// All of them, best first: what costs nothing, then what has to be decoded, then what lacks colour.
inline constexpr CameraFormat kEveryCameraFormat[] = {
    CameraFormat::kYuyv,  CameraFormat::kNv12,  CameraFormat::kI420, CameraFormat::kRgb24,
    CameraFormat::kBgr24, CameraFormat::kMjpeg, CameraFormat::kGrey8};

// As facewire.toml and `facewire doctor` write it.
constexpr std::string_view Name(CameraFormat format) noexcept {
  constexpr std::string_view kNames[] = {"yuyv", "nv12", "i420", "rgb24", "bgr24", "mjpeg", "grey"};
  return kNames[static_cast<std::size_t>(format)];
}

// What Frame::image is made of.
constexpr PixelFormat PixelFormatOf(CameraFormat format) noexcept {
  constexpr PixelFormat kFormats[] = {PixelFormat::kYuyv,  PixelFormat::kNv12,  PixelFormat::kI420,
                                      PixelFormat::kRgb24, PixelFormat::kBgr24, PixelFormat::kRgb24,
                                      PixelFormat::kGrey8};
  return kFormats[static_cast<std::size_t>(format)];
}

}  // namespace facewire::hal

#endif  // FACEWIRE_HAL_CAMERA_FORMAT_H_
