#ifndef FACEWIRE_HAL_FAKE_FAKE_CAMERA_H_
#define FACEWIRE_HAL_FAKE_FAKE_CAMERA_H_

#include <optional>
#include <span>

#include "hal/camera.h"
#include "hal/clock.h"
#include "hal/playback.h"

namespace facewire::hal::fake {

struct FakeCameraConfig {
  std::span<const ImageView> pictures;  // borrowed, pixels too, for the camera's life; at least one
  double fps = 30;
  Pace pace = Pace::kRealTime;
  LoopMode loop = LoopMode::kRestart;
};

// Shows a script of pictures from borrowed memory by the clock's time, and fails on demand. Nothing
// allocates. Not thread-safe.
class FakeCamera final : public Camera {
 public:
  // `clock` is borrowed for the camera's life.
  FakeCamera(const FakeCameraConfig& config, Clock& clock) noexcept
      : config_(config), clock_(clock) {}

  // kInvalidArgument: no pictures, or an fps that is not above 0.
  Result<> Start() override;
  Result<Frame> Acquire(std::chrono::milliseconds timeout) override;
  void Release(const Frame& frame) override;
  void Stop() override { pacer_.reset(); }
  CameraCounts counts() const override { return counts_; }

  // A camera that hangs: every Acquire times out until Resume. The frames of that while are missed.
  void FallSilent() noexcept { silent_ = true; }
  void Resume() noexcept { silent_ = false; }
  // Pulls the plug: Acquire answers kDisconnected, and Start kNotFound until Plug.
  void Unplug() noexcept;
  void Plug() noexcept { plugged_ = true; }
  // The recording is over after the frame that is shown now: Acquire answers kEnd until the next
  // Start.
  void End() noexcept { ended_ = true; }
  // The next `times` Starts answer `fault` (kBusy, kPermission, ...).
  void FailStarts(int times, Errc fault) noexcept {
    start_failures_ = times;
    start_fault_ = fault;
  }

  // Pictures that came broken, and that nobody gets to see.
  void Damage(std::uint64_t pictures) noexcept { counts_.damaged += pictures; }

  bool started() const noexcept { return pacer_.has_value(); }
  // Frames handed out and not yet given back: 0 or 1 with a caller that keeps the contract.
  int outstanding() const noexcept { return outstanding_; }

 private:
  FakeCameraConfig config_;
  Clock& clock_;
  std::optional<Pacer> pacer_;  // while started
  std::uint64_t next_ = 0;
  CameraCounts counts_;
  int outstanding_ = 0;
  bool silent_ = false;
  bool plugged_ = true;
  bool ended_ = false;
  int start_failures_ = 0;
  Errc start_fault_ = Errc::kIo;
};

}  // namespace facewire::hal::fake

#endif  // FACEWIRE_HAL_FAKE_FAKE_CAMERA_H_
