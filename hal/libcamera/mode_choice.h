#ifndef FACEWIRE_HAL_LIBCAMERA_MODE_CHOICE_H_
#define FACEWIRE_HAL_LIBCAMERA_MODE_CHOICE_H_

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "core/base/time.h"
#include "hal/camera_format.h"

// What to ask a camera for, and how to read what it says of a picture: pure, without libcamera.
namespace facewire::hal::libcamera {

struct Mode {
  CameraFormat format = CameraFormat::kYuyv;
  int width_px = 0;
  int height_px = 0;

  bool operator==(const Mode&) const = default;
};

// "nv12 640x480"
std::string Describe(const Mode& mode);

// The first preferred format that has the size; when none has it, the most preferred one that
// there is, in its nearest size. nullopt: nothing that is offered is preferred.
std::optional<Mode> ChooseMode(std::span<const Mode> offered,
                               std::span<const CameraFormat> preferred, int width_px,
                               int height_px) noexcept;

// The time between two frames in microseconds that comes nearest to `fps` within what the camera
// can do.
std::int64_t ChooseFrameDuration(double fps, std::int64_t shortest_us,
                                 std::int64_t longest_us) noexcept;

// When a frame was captured. `stamp_ns` is the camera's, on a clock that libcamera's documentation
// leaves open; in practice it is the monotonic one. One that lies more than ten seconds off is on
// another clock, and `now`, when the frame was fetched, is taken.
Time CaptureTime(std::uint64_t stamp_ns, Time now) noexcept;

// Carries a camera's 32-bit count of frames on beyond 32 bits, from 0 at the first frame. A count
// that repeats itself or goes back (a camera that began anew) makes the frame just the next one.
class FrameCount {
 public:
  void Reset() noexcept { *this = {}; }
  std::uint64_t Next(std::uint32_t sequence) noexcept;

 private:
  bool counting_ = false;
  std::uint32_t last_ = 0;
  std::uint64_t count_ = 0;
};

}  // namespace facewire::hal::libcamera

#endif  // FACEWIRE_HAL_LIBCAMERA_MODE_CHOICE_H_
