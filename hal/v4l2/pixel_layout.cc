#include "hal/v4l2/pixel_layout.h"

#include <linux/videodev2.h>

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

// A picture of a size that no camera has is a damaged answer, and its bytes must not overflow an
// int.
constexpr int kMaxSidePx = 16384;

int BytesPerPixel(PixelFormat format) noexcept {
  switch (format) {
    case PixelFormat::kGrey8:
    case PixelFormat::kNv12:
    case PixelFormat::kI420:
      return 1;  // of the first plane
    case PixelFormat::kYuyv:
      return 2;
    case PixelFormat::kRgb24:
    case PixelFormat::kBgr24:
      return 3;
  }
  return 0;
}

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

ImageView PixelLayout::At(const std::uint8_t* buffer) const noexcept {
  ImageView at = view;
  for (std::size_t i = 0; i < at.planes.size(); ++i) {
    if (at.planes[i].stride_bytes > 0) at.planes[i].data = buffer + plane_offsets[i];
  }
  return at;
}

Result<PixelLayout> LayOut(PixelFormat format, int width_px, int height_px,
                           std::uint32_t stride_bytes) noexcept {
  if (width_px <= 0 || height_px <= 0 || width_px > kMaxSidePx || height_px > kMaxSidePx) {
    return Errc::kUnsupported;
  }
  const bool planar = format == PixelFormat::kNv12 || format == PixelFormat::kI420;
  if ((planar || format == PixelFormat::kYuyv) && width_px % 2 != 0) return Errc::kUnsupported;
  if (planar && height_px % 2 != 0) return Errc::kUnsupported;
  const int row_bytes = width_px * BytesPerPixel(format);
  const int stride = stride_bytes == 0 ? row_bytes : static_cast<int>(stride_bytes);
  if (stride_bytes > 4U * kMaxSidePx || stride < row_bytes) return Errc::kUnsupported;

  PixelLayout layout;
  layout.view.format = format;
  layout.view.width_px = width_px;
  layout.view.height_px = height_px;
  layout.view.planes[0].stride_bytes = stride;
  // V4L2's single-buffer planar formats put the planes one after the other without a gap; the
  // chroma stride follows from the first plane's (kernel documentation, "YUV formats, planar").
  const auto first = static_cast<std::size_t>(stride) * static_cast<std::size_t>(height_px);
  const std::size_t rows = static_cast<std::size_t>(height_px) / 2;
  layout.bytes = first;
  if (format == PixelFormat::kNv12) {
    layout.view.planes[1].stride_bytes = stride;
    layout.plane_offsets[1] = first;
    layout.bytes = first + rows * static_cast<std::size_t>(stride);
  } else if (format == PixelFormat::kI420) {
    const int half = stride / 2;
    layout.view.planes[1].stride_bytes = layout.view.planes[2].stride_bytes = half;
    layout.plane_offsets[1] = first;
    layout.plane_offsets[2] = first + rows * static_cast<std::size_t>(half);
    layout.bytes = first + 2 * rows * static_cast<std::size_t>(half);
  }
  return layout;
}

}  // namespace facewire::hal::v4l2
