#ifndef FACEWIRE_HAL_PLAYBACK_H_
#define FACEWIRE_HAL_PLAYBACK_H_

#include <chrono>
#include <cstdint>

#include "core/base/result.h"
#include "core/base/time.h"
#include "hal/clock.h"

namespace facewire::hal {

// When the frames of a recording are shown, and which. Shared by every camera that plays one.

enum class Pace : std::uint8_t {
  kRealTime,  // frame n is captured at start + n / fps by the clock; who comes late misses frames
  kFast,      // every frame at once, none missed; captured at n / fps from the origin of time
};

enum class LoopMode : std::uint8_t {
  kNone,      // the recording ends (kEnd)
  kRestart,   // begins again: a jump in the picture, which a tracker sees as a jump of the face
  kPingPong,  // forwards, backwards, forwards: no jump, but every motion is also seen reversed
};

// The index of the picture that is shown as the n-th, of `count` (at least 1) pictures.
constexpr std::uint64_t LoopIndex(LoopMode mode, std::uint64_t n, std::uint64_t count) noexcept {
  if (mode == LoopMode::kNone || count == 1) return mode == LoopMode::kNone ? n : 0;
  if (mode == LoopMode::kRestart) return n % count;
  const std::uint64_t turn = 2 * (count - 1);  // the pictures at both ends are shown once a turn
  const std::uint64_t at = n % turn;
  return at < count ? at : turn - at;
}

class Pacer {
 public:
  // The recording starts now, or at the origin of time when the pace is kFast. fps > 0.
  // `clock` is borrowed for the pacer's life.
  Pacer(Clock& clock, Pace pace, double fps)
      : clock_(clock), pace_(pace), fps_(fps), start_(pace == Pace::kFast ? Time{} : clock.Now()) {}

  // From n rather than by adding up periods, which would drift when 1 / fps is no whole number of
  // us.
  Time CapturedAt(std::uint64_t n) const noexcept {
    return start_ + std::chrono::round<Duration>(
                        std::chrono::duration<double>(static_cast<double>(n) / fps_));
  }

  // The number of the newest frame that is due, at least `next`; in real time waits for `next` to
  // become due. kTimeout when it does not within `timeout`.
  Result<std::uint64_t> Wait(std::uint64_t next, std::chrono::milliseconds timeout) {
    if (pace_ == Pace::kFast) return next;
    const Time now = clock_.Now();
    if (CapturedAt(next) > now + timeout) {
      clock_.SleepUntil(now + timeout);
      return Errc::kTimeout;
    }
    clock_.SleepUntil(CapturedAt(next));
    const Time awake = clock_.Now();
    auto newest =
        static_cast<std::uint64_t>(std::chrono::duration<double>(awake - start_).count() * fps_);
    // The product is off by less than one frame either way; the rounded times decide.
    if (CapturedAt(newest + 1) <= awake) ++newest;
    if (newest > next && CapturedAt(newest) > awake) --newest;
    return newest > next ? newest : next;
  }

 private:
  Clock& clock_;
  Pace pace_;
  double fps_;
  Time start_;
};

}  // namespace facewire::hal

#endif  // FACEWIRE_HAL_PLAYBACK_H_
