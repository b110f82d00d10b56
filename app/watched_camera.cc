#include "app/watched_camera.h"

#include <algorithm>
#include <chrono>

namespace facewire::app {

WatchedCamera::WatchedCamera(hal::Camera& camera, hal::Clock& clock, ServiceStats& stats) noexcept
    : camera_(camera), clock_(clock), stats_(stats) {
  last_picture_ = last_fresh_ = clock_.Now();
}

Result<Frame> WatchedCamera::Wait(Time deadline, Duration silence) noexcept {
  if (!running_ && !ended_) Start();
  if (!running_) return Errc::kDisconnected;
  const Duration left = std::max(deadline - clock_.Now(), Duration{});
  const Result<Frame> frame = camera_.Acquire(std::chrono::ceil<std::chrono::milliseconds>(left));
  CountDamaged();
  if (frame) {
    Came(*frame);
  } else {
    Missed(frame.error(), silence);
  }
  return frame;
}

void WatchedCamera::Start() noexcept {
  if (!restart_.Due(clock_.Now())) return;
  ++stats_.camera_restarts;
  damaged_ = 0;
  running_ = opens_ = camera_.Start().has_value();
  last_seq_.reset();
  // Only a picture ends the back-off: a camera may start and stay silent again and again.
  restart_.Failed(clock_.Now());
}

void WatchedCamera::CountDamaged() noexcept {
  const std::uint64_t now = camera_.counts().damaged;
  stats_.frames_damaged += now - damaged_;
  damaged_ = now;
}

void WatchedCamera::Came(const Frame& frame) noexcept {
  last_picture_ = clock_.Now();
  if (frame.captured != captured_) last_fresh_ = last_picture_;
  captured_ = frame.captured;
  restart_.Succeeded();
  if (last_seq_ && frame.seq > *last_seq_ + 1) stats_.frames_dropped += frame.seq - *last_seq_ - 1;
  last_seq_ = frame.seq;
  ++stats_.frames;
}

void WatchedCamera::Missed(Errc why, Duration silence) noexcept {
  if (why == Errc::kEnd) {
    ended_ = true;
    running_ = false;
    return;
  }
  const Time now = clock_.Now();
  const bool silent = now - last_picture_ > silence && restart_.Due(now);
  if (why == Errc::kTimeout && !silent) return;
  if (why != Errc::kTimeout) ++stats_.camera_errors;
  camera_.Stop();
  running_ = false;
}

WatchedCamera::Health WatchedCamera::health(Duration silence) const noexcept {
  if (!opens_) return Health::kGone;
  return running_ && clock_.Now() - last_fresh_ <= silence ? Health::kUp : Health::kSilent;
}

bool WatchedCamera::Stuck(Duration silence) const noexcept {
  return opens_ && !ended_ && clock_.Now() - last_fresh_ > 3 * silence;
}

}  // namespace facewire::app
