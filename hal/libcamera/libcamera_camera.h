#ifndef FACEWIRE_HAL_LIBCAMERA_LIBCAMERA_CAMERA_H_
#define FACEWIRE_HAL_LIBCAMERA_LIBCAMERA_CAMERA_H_

#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "hal/camera.h"
#include "hal/clock.h"
#include "hal/jpeg/jpeg_decoder.h"
#include "hal/libcamera/session.h"

namespace facewire::hal::libcamera {

// A camera through libcamera: the Raspberry Pi's camera modules, other boards' sensors, USB
// webcams. Frame::image lies in the driver's memory, or in a decoder's for a camera that sends
// JPEGs. Frame::seq starts at 0 and has the camera's gaps.
class LibcameraCamera final : public Camera {
 public:
  // `clock` is borrowed for the camera's life.
  LibcameraCamera(LibcameraConfig config, Clock& clock,
                  std::unique_ptr<Session> session = MakeLibrarySession());
  ~LibcameraCamera() override;
  LibcameraCamera(const LibcameraCamera&) = delete;
  LibcameraCamera& operator=(const LibcameraCamera&) = delete;

  Result<> Start() override;
  // After kDisconnected everything is given back and Start may be tried. A camera that is silent is
  // kTimeout: not every driver says that its device has gone, so the caller decides how long is too
  // long.
  Result<Frame> Acquire(std::chrono::milliseconds timeout) override;
  void Release(const Frame& frame) override;
  void Stop() override;
  std::string_view reason() const override { return reason_; }
  CameraCounts counts() const override { return counts_; }

  const Negotiated& negotiated() const noexcept { return negotiated_; }  // of the last good Start
  std::string Describe() const;  // the same in one line, for logs

 private:
  Result<> Fail(Errc code, std::string_view why);
  Result<> Prepare();
  bool IsWhole(const Completion& completion) const noexcept;
  const Completion* Newest(const Completions& completions);
  Result<Frame> FrameOf(const Completion& completion);

  LibcameraConfig config_;
  Clock& clock_;
  HandOver hand_over_;  // outlives the session, whose thread fills it
  std::unique_ptr<Session> session_;
  bool running_ = false;
  Negotiated negotiated_;
  PixelLayout layout_;                        // of pixels; without planes for JPEGs
  std::optional<jpeg::JpegDecoder> decoder_;  // for JPEGs
  FrameCount count_;
  int held_ = -1;  // the buffer that the caller has, or -1
  CameraCounts counts_;
  std::string gone_;     // what Acquire says, without allocating: the camera has gone,
  std::string damaged_;  // or its pictures are broken
  std::string refusal_;  // what Start says
  std::string_view reason_;
};

}  // namespace facewire::hal::libcamera

#endif  // FACEWIRE_HAL_LIBCAMERA_LIBCAMERA_CAMERA_H_
