#ifndef FACEWIRE_APP_WATCHED_CAMERA_H_
#define FACEWIRE_APP_WATCHED_CAMERA_H_

#include <cstdint>
#include <optional>

#include "app/backoff.h"
#include "app/service_stats.h"
#include "core/base/result.h"
#include "core/base/time.h"
#include "core/frame.h"
#include "hal/camera.h"
#include "hal/clock.h"

namespace facewire::app {

// A camera that is kept going: one that fails or falls silent is stopped and started again, ever
// more patiently. All that it is given is borrowed. Times are the clock's, but a frame's own.
class WatchedCamera {
 public:
  enum class Health : std::uint8_t { kUp, kSilent, kGone };

  // `camera` is started. What happens to it is counted in `stats`.
  WatchedCamera(hal::Camera& camera, hal::Clock& clock, ServiceStats& stats) noexcept;
  WatchedCamera(const WatchedCamera&) = delete;
  WatchedCamera& operator=(const WatchedCamera&) = delete;

  // The next picture, to be given back with Release, waited for until `deadline`. Errors as
  // hal::Camera::Acquire; kDisconnected, at once, while it does not run. A camera that has sent
  // nothing for `silence` is started again. Allocates only where it is.
  Result<Frame> Wait(Time deadline, Duration silence) noexcept;
  void Release(const Frame& frame) noexcept { camera_.Release(frame); }

  bool running() const noexcept { return running_; }
  // A recording is over; it is not started again.
  bool ended() const noexcept { return ended_; }
  // When the last picture came.
  Time last_picture() const noexcept { return last_picture_; }
  // How it is, when pictures that are `silence` apart are too rare.
  Health health(Duration silence) const noexcept;
  // It opens, but has sent no fresh picture for three times `silence` although it was started
  // again.
  bool Stuck(Duration silence) const noexcept;

 private:
  void Start() noexcept;
  void CountDamaged() noexcept;
  void Came(const Frame& frame) noexcept;
  void Missed(Errc why, Duration silence) noexcept;

  hal::Camera& camera_;
  hal::Clock& clock_;
  ServiceStats& stats_;
  bool running_ = true;
  bool opens_ = true;  // at the last try
  bool ended_ = false;
  std::uint64_t damaged_ = 0;  // pictures that the camera dropped since its start
  Backoff restart_;
  std::optional<std::uint64_t> last_seq_;
  Time last_picture_{};
  Time last_fresh_{};  // a picture that was not the one before
  Time captured_{};    // of that one, its own
};

}  // namespace facewire::app

#endif  // FACEWIRE_APP_WATCHED_CAMERA_H_
