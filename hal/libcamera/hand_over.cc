#include "hal/libcamera/hand_over.h"

#include <utility>

namespace facewire::hal::libcamera {

void HandOver::Reset() noexcept {
  const std::lock_guard lock(mutex_);
  completed_.clear();
  lost_ = false;
}

void HandOver::Push(const Completion& completion) noexcept {
  {
    const std::lock_guard lock(mutex_);
    // Never full: a buffer is completed once, and goes back to libcamera only after Take.
    static_cast<void>(completed_.try_push(completion));
  }
  changed_.notify_one();
}

void HandOver::Lose() noexcept {
  {
    const std::lock_guard lock(mutex_);
    lost_ = true;
  }
  changed_.notify_one();
}

Result<Completions> HandOver::Take(std::chrono::steady_clock::time_point deadline) {
  std::unique_lock lock(mutex_);
  changed_.wait_until(lock, deadline, [this] { return lost_ || !completed_.empty(); });
  if (lost_) return Errc::kDisconnected;
  if (completed_.empty()) return Errc::kTimeout;
  return std::exchange(completed_, {});
}

}  // namespace facewire::hal::libcamera
