#include "hal/v4l2/frame_rate.h"

#include <linux/videodev2.h>

#include <algorithm>
#include <cmath>

namespace facewire::hal::v4l2 {
namespace {

constexpr std::uint32_t kMostListed = 64;  // a driver that never ends is no reason to hang
constexpr std::uint32_t kTicks = 1'000'000;

void Add(const v4l2_fract& period, std::vector<Period>& periods) {
  if (period.numerator == 0 || period.denominator == 0) return;
  periods.push_back({.numerator = period.numerator, .denominator = period.denominator});
}

}  // namespace

Period FrameRates::Nearest(double fps) const noexcept {
  if (periods.empty()) return {};
  if (range) {
    // The driver rounds to its step.
    if (fps >= periods.front().fps()) return periods.front();
    if (fps <= periods.back().fps()) return periods.back();
    return {.numerator = static_cast<std::uint32_t>(std::lround(kTicks / fps)),
            .denominator = kTicks};
  }
  const auto distance = [fps](const Period& period) {
    constexpr double kFasterWins = 1e-6;
    const double octaves = std::log2(period.fps() / fps);
    return std::abs(octaves) - (octaves > 0 ? kFasterWins : 0);
  };
  return *std::ranges::min_element(periods, {}, distance);
}

FrameRates ReadFrameRates(SystemCalls& calls, int fd, std::uint32_t fourcc, std::uint32_t width_px,
                          std::uint32_t height_px) {
  FrameRates rates;
  for (std::uint32_t i = 0; i < kMostListed; ++i) {
    v4l2_frmivalenum interval{};
    interval.index = i;
    interval.pixel_format = fourcc;
    interval.width = width_px;
    interval.height = height_px;
    if (Call(calls, fd, VIDIOC_ENUM_FRAMEINTERVALS, &interval) != 0) break;
    if (interval.type == V4L2_FRMIVAL_TYPE_DISCRETE) {
      Add(interval.discrete, rates.periods);
      continue;
    }
    Add(interval.stepwise.min, rates.periods);
    Add(interval.stepwise.max, rates.periods);
    rates.range = rates.periods.size() == 2;
    break;
  }
  return rates;
}

}  // namespace facewire::hal::v4l2
