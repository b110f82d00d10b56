#include "hal/libcamera/mode_choice.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace facewire::hal::libcamera {

std::string Describe(const Mode& mode) {
  return std::string(Name(mode.format)) + " " + std::to_string(mode.width_px) + "x" +
         std::to_string(mode.height_px);
}

std::optional<Mode> ChooseMode(std::span<const Mode> offered,
                               std::span<const CameraFormat> preferred, int width_px,
                               int height_px) noexcept {
  for (const CameraFormat format : preferred) {
    const Mode exact{format, width_px, height_px};
    if (std::find(offered.begin(), offered.end(), exact) != offered.end()) return exact;
  }
  const auto distance = [&](const Mode& mode) {
    return std::abs(mode.width_px - width_px) + std::abs(mode.height_px - height_px);
  };
  for (const CameraFormat format : preferred) {
    std::optional<Mode> nearest;
    for (const Mode& mode : offered) {
      if (mode.format != format) continue;
      if (!nearest || distance(mode) < distance(*nearest)) nearest = mode;
    }
    if (nearest) return nearest;
  }
  return std::nullopt;
}

std::int64_t ChooseFrameDuration(double fps, std::int64_t shortest_us,
                                 std::int64_t longest_us) noexcept {
  const auto wanted = static_cast<std::int64_t>(std::llround(1e6 / fps));
  return std::clamp(wanted, shortest_us, std::max(shortest_us, longest_us));
}

Time CaptureTime(std::uint64_t stamp_ns, Time now) noexcept {
  constexpr std::chrono::seconds kFarthest(10);
  const Time stamp{Duration(static_cast<Duration::rep>(stamp_ns / 1000))};
  const Duration age = Between(stamp, now);
  return stamp > Time{} && age <= kFarthest && age >= -kFarthest ? stamp : now;
}

std::uint64_t FrameCount::Next(std::uint32_t sequence) noexcept {
  constexpr std::uint32_t kBackwards = 0x80000000U;
  const std::uint32_t step = sequence - last_;
  if (counting_) count_ += step == 0 || step >= kBackwards ? 1 : step;
  last_ = sequence;
  counting_ = true;
  return count_;
}

}  // namespace facewire::hal::libcamera
