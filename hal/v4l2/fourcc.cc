#include "hal/v4l2/fourcc.h"

#include <linux/videodev2.h>

#include <cstddef>

namespace facewire::hal::v4l2 {
namespace {

struct Pair {
  CameraFormat format;
  std::uint32_t fourcc;
};
constexpr Pair kPairs[] = {
    {CameraFormat::kYuyv, V4L2_PIX_FMT_YUYV},   {CameraFormat::kNv12, V4L2_PIX_FMT_NV12},
    {CameraFormat::kI420, V4L2_PIX_FMT_YUV420}, {CameraFormat::kRgb24, V4L2_PIX_FMT_RGB24},
    {CameraFormat::kBgr24, V4L2_PIX_FMT_BGR24}, {CameraFormat::kMjpeg, V4L2_PIX_FMT_MJPEG},
    {CameraFormat::kGrey8, V4L2_PIX_FMT_GREY},
};

}  // namespace

std::uint32_t FourccOf(CameraFormat format) noexcept {
  for (const Pair& pair : kPairs) {
    if (pair.format == format) return pair.fourcc;
  }
  return 0;
}

std::optional<CameraFormat> FormatOf(std::uint32_t fourcc) noexcept {
  for (const Pair& pair : kPairs) {
    if (pair.fourcc == fourcc) return pair.format;
  }
  return std::nullopt;
}

std::array<char, 5> FourccText(std::uint32_t fourcc) noexcept {
  std::array<char, 5> text{};
  for (std::size_t i = 0; i < 4; ++i) {
    const auto letter = static_cast<unsigned char>(fourcc >> (8 * i));
    text[i] = letter >= ' ' && letter <= '~' ? static_cast<char>(letter) : '?';
  }
  return text;
}

}  // namespace facewire::hal::v4l2
