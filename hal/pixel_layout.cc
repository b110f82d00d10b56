#include "hal/pixel_layout.h"

namespace facewire::hal {
namespace {

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
  // Planar formats in one buffer put the planes one after the other without a gap; the
  // chroma stride follows from the first plane's (V4L2 documentation, "YUV formats, planar").
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

}  // namespace facewire::hal
