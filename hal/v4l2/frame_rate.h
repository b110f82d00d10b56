#ifndef FACEWIRE_HAL_V4L2_FRAME_RATE_H_
#define FACEWIRE_HAL_V4L2_FRAME_RATE_H_

#include <cstdint>
#include <vector>

#include "hal/v4l2/system_calls.h"

namespace facewire::hal::v4l2 {

// The time from one frame to the next, in seconds: numerator / denominator.
struct Period {
  std::uint32_t numerator = 0;
  std::uint32_t denominator = 0;  // 0: not known

  double fps() const noexcept {
    return numerator == 0 ? 0 : static_cast<double>(denominator) / numerator;
  }
};

// The rates that a device has for a format (V4L2_PIX_FMT_...) and size.
struct FrameRates {
  std::vector<Period> periods;  // in the device's order; empty: it does not say
  bool range = false;           // periods are the shortest and the longest; all between may be had

  // The period whose rate is nearest by ratio: 15 Hz and 60 Hz are equally far from 30 Hz, and of
  // those the faster wins. An unknown one when the device does not say.
  Period Nearest(double fps) const noexcept;
};
FrameRates ReadFrameRates(SystemCalls& calls, int fd, std::uint32_t fourcc, std::uint32_t width_px,
                          std::uint32_t height_px);

}  // namespace facewire::hal::v4l2

#endif  // FACEWIRE_HAL_V4L2_FRAME_RATE_H_
