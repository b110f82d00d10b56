#ifndef FACEWIRE_HAL_CAMERA_H_
#define FACEWIRE_HAL_CAMERA_H_

#include <chrono>
#include <cstdint>
#include <string_view>

#include "core/base/result.h"
#include "core/frame.h"

namespace facewire::hal {

struct CameraCounts {
  std::uint64_t damaged = 0;  // pictures that came broken and were dropped
};

// A source of frames. Not thread-safe: one thread calls everything.
// Life: Start, then pairs of Acquire and Release, then Stop; Start again after Stop or after
// kDisconnected. Destruction stops.
class Camera {
 public:
  virtual ~Camera() = default;

  // Opens the device, negotiates format and rate, allocates every buffer, starts the stream.
  // kNotFound, kBusy, kPermission, kUnsupported (no usable format or rate), kIo.
  virtual Result<> Start() = 0;

  // The newest frame that the camera has; older ones are dropped and show as a gap in Frame::seq
  // (a recording played "as fast as possible" drops none). Waits until `timeout` at most.
  // The pixels stay until Release, which comes before the next Acquire. Allocates nothing.
  // kTimeout (silence), kDisconnected (device gone), kEnd (a recording is over), kIo.
  virtual Result<Frame> Acquire(std::chrono::milliseconds timeout) = 0;

  // Gives the frame's memory back to the camera.
  virtual void Release(const Frame& frame) = 0;

  virtual void Stop() = 0;

  // Why the last call failed, for a person; empty where the code says it all. Until the next call.
  virtual std::string_view reason() const { return {}; }
  // Since Start.
  virtual CameraCounts counts() const { return {}; }
};

}  // namespace facewire::hal

#endif  // FACEWIRE_HAL_CAMERA_H_
