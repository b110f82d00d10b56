#ifndef FACEWIRE_HAL_CAMERA_H_
#define FACEWIRE_HAL_CAMERA_H_

#include <chrono>

#include "core/base/result.h"
#include "core/frame.h"

namespace facewire::hal {

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
};

}  // namespace facewire::hal

#endif  // FACEWIRE_HAL_CAMERA_H_
