#ifndef FACEWIRE_CORE_FRAME_H_
#define FACEWIRE_CORE_FRAME_H_

#include <array>
#include <cstdint>
#include <type_traits>

#include "core/base/time.h"

namespace facewire {

enum class PixelFormat : std::uint8_t {
  kGrey8,  // 1 plane, 1 byte a pixel
  kYuyv,   // 1 plane, Y0 U Y1 V
  kNv12,   // 2 planes: Y, then U and V interleaved at half size
  kI420,   // 3 planes: Y, U, V; U and V at half size
  kRgb24,  // 1 plane, R G B
  kBgr24,  // 1 plane, B G R
};

// How the YUV formats encode colour. Webcams and the Raspberry Pi's pipelines deliver BT.601.
enum class YuvEncoding : std::uint8_t { kBt601Limited, kBt601Full };

struct Plane {
  const std::uint8_t* data = nullptr;
  int stride_bytes = 0;  // from one row to the next, at least the row's own bytes
};

// Borrowed pixels: whoever handed out the view says how long they stay. Row 0 is the top.
struct ImageView {
  PixelFormat format = PixelFormat::kGrey8;
  YuvEncoding encoding = YuvEncoding::kBt601Limited;
  int width_px = 0;
  int height_px = 0;
  std::array<Plane, 3> planes{};
};

// One picture of a camera. The pixels are borrowed until the camera gets the frame back
// (hal::Camera::Release).
struct Frame {
  std::uint64_t seq = 0;  // counts what the camera captured; a gap is a frame nobody saw
  Time captured{};
  ImageView image;
};
static_assert(std::is_trivially_copyable_v<Frame>);

}  // namespace facewire

#endif  // FACEWIRE_CORE_FRAME_H_
