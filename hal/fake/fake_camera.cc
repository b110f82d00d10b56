#include "hal/fake/fake_camera.h"

namespace facewire::hal::fake {

Result<> FakeCamera::Start() {
  if (pacer_) return {};
  if (config_.pictures.empty() || !(config_.fps > 0)) return Errc::kInvalidArgument;
  if (start_failures_ > 0) {
    --start_failures_;
    return start_fault_;
  }
  if (!plugged_) return Errc::kNotFound;
  pacer_.emplace(clock_, config_.pace, config_.fps);
  next_ = 0;
  outstanding_ = 0;
  counts_ = {};
  ended_ = false;
  return {};
}

void FakeCamera::Unplug() noexcept {
  plugged_ = false;
  pacer_.reset();
}

Result<Frame> FakeCamera::Acquire(std::chrono::milliseconds timeout) {
  if (!pacer_) return Errc::kDisconnected;
  if (ended_) return Errc::kEnd;
  if (silent_) {
    clock_.SleepUntil(clock_.Now() + timeout);
    return Errc::kTimeout;
  }
  const std::uint64_t count = config_.pictures.size();
  if (config_.loop == LoopMode::kNone && next_ >= count) return Errc::kEnd;
  const Result<std::uint64_t> n = pacer_->Wait(next_, timeout);
  if (!n) return n.error();
  if (config_.loop == LoopMode::kNone && *n >= count) return Errc::kEnd;
  next_ = *n + 1;
  ++outstanding_;
  return Frame{.seq = *n,
               .captured = pacer_->CapturedAt(*n),
               .image = config_.pictures[LoopIndex(config_.loop, *n, count)]};
}

void FakeCamera::Release(const Frame& /*frame*/) {
  if (outstanding_ > 0) --outstanding_;
}

}  // namespace facewire::hal::fake
