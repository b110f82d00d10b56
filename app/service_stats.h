#ifndef FACEWIRE_APP_SERVICE_STATS_H_
#define FACEWIRE_APP_SERVICE_STATS_H_

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "core/base/time.h"

namespace facewire::app {

// How long things took, counted in fixed steps; longer ones count as the last step.
class LatencyHistogram {
 public:
  static constexpr Duration kStep = std::chrono::microseconds(250);
  static constexpr std::size_t kSteps = 2000;  // half a second

  void Add(Duration latency) noexcept {
    const auto step = std::max<std::int64_t>(latency / kStep, 0);
    ++counts_[std::min<std::size_t>(static_cast<std::size_t>(step), kSteps - 1)];
    ++total_;
  }
  void Clear() noexcept { *this = {}; }
  std::uint64_t total() const noexcept { return total_; }

  // The upper end of the step in which the q'th part (0..1) of all lies; zero when there is none.
  Duration Quantile(double q) const noexcept {
    if (total_ == 0) return {};
    const auto wanted = static_cast<std::uint64_t>(q * static_cast<double>(total_ - 1)) + 1;
    std::uint64_t seen = 0;
    std::size_t step = 0;
    while (step < kSteps - 1 && (seen += counts_[step]) < wanted) ++step;
    return kStep * static_cast<std::int64_t>(step + 1);
  }

 private:
  std::array<std::uint32_t, kSteps> counts_{};
  std::uint64_t total_ = 0;
};

// Counts blinks in the weight of the more closed eye: one for each rise above half, after it was
// below a third.
class BlinkCounter {
 public:
  void Update(float closed) noexcept {
    if (!closed_ && closed > 0.5F) {
      closed_ = true;
      ++count_;
    } else if (closed_ && closed < 1.0F / 3) {
      closed_ = false;
    }
  }
  std::uint64_t count() const noexcept { return count_; }

 private:
  bool closed_ = false;
  std::uint64_t count_ = 0;
};

// What the hot path counts instead of printing. Since the start of the service.
struct ServiceStats {
  std::uint64_t ticks = 0;
  std::uint64_t frames = 0;           // pictures processed
  std::uint64_t frames_dropped = 0;   // captured by the camera, but seen by nobody (gaps in seq)
  std::uint64_t frames_damaged = 0;   // came broken from the camera, and were dropped there
  std::uint64_t faces = 0;            // frames with a face to follow
  std::uint64_t rejected = 0;         // frames with a face that cannot be right
  std::uint64_t losses = 0;           // times that tracking was lost
  std::uint64_t silent_ticks = 0;     // ticks without a picture
  std::uint64_t camera_restarts = 0;  // attempts
  std::uint64_t camera_errors = 0;
  std::uint64_t commands = 0;
  std::uint64_t reloads = 0;
  LatencyHistogram latency;  // from capture (a fast replay: from acquisition) to the line
  BlinkCounter blinks;
};

}  // namespace facewire::app

#endif  // FACEWIRE_APP_SERVICE_STATS_H_
