#ifndef FACEWIRE_HAL_V4L2_V4L2_CAMERA_H_
#define FACEWIRE_HAL_V4L2_V4L2_CAMERA_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/inline_vector.h"
#include "hal/camera.h"
#include "hal/camera_format.h"
#include "hal/clock.h"
#include "hal/jpeg/jpeg_decoder.h"
#include "hal/pixel_layout.h"
#include "hal/v4l2/frame_rate.h"
#include "hal/v4l2/system_calls.h"

struct v4l2_buffer;
struct v4l2_format;

namespace facewire::hal::v4l2 {

struct V4l2Config {
  std::string device = "/dev/video0";
  // What is asked for. A device that cannot do it gives what comes nearest: see V4l2Camera::mode().
  int width_px = 640;
  int height_px = 480;
  double fps = 30;
  double lowest_fps = 10;  // a camera that is slower than this is refused: the rig would stutter
  // What may be taken, best first. Size goes before rate, and rate before this order.
  std::vector<CameraFormat> formats{std::begin(kEveryCameraFormat), std::end(kEveryCameraFormat)};
  // More ride out a longer stall of the program, and cost a picture's memory each.
  int buffer_count = 4;  // 2..32
};

// What was negotiated.
struct V4l2Mode {
  std::array<char, 32> driver{};
  std::array<char, 32> card{};
  CameraFormat format{};
  PixelLayout layout;  // of a frame's pixels
  double fps = 0;      // 0: the driver does not say
  int buffer_count = 0;
};

// Since Start.
struct V4l2Stats {
  std::uint64_t frames = 0;      // handed out
  std::uint64_t superseded = 0;  // good, but a newer one was there
  std::uint64_t damaged = 0;     // marked so by the driver, shorter than a picture, no whole JPEG
};

// A camera of the kernel's V4L2 interface (USB webcams, simple sensors): memory-mapped buffers,
// single-plane capture. Frame::image lies in the driver's memory, nothing is copied; of a
// compressed format it lies in the decoder's. Frame::seq starts at 0 and has the driver's gaps.
// Frame::captured is the driver's when it stamps with the monotonic clock, otherwise the clock's
// time when the frame was fetched.
class V4l2Camera final : public Camera {
 public:
  // `clock` and `calls` are borrowed for the camera's life.
  V4l2Camera(V4l2Config config, Clock& clock, SystemCalls& calls = LinuxCalls());
  ~V4l2Camera() override;
  V4l2Camera(const V4l2Camera&) = delete;
  V4l2Camera& operator=(const V4l2Camera&) = delete;

  Result<> Start() override;
  // kIo leaves the stream running; after kDisconnected everything is given back and Start may be
  // tried.
  Result<Frame> Acquire(std::chrono::milliseconds timeout) override;
  void Release(const Frame& frame) override;
  void Stop() override;

  // Which step failed, why, and what would be right.
  std::string_view reason() const override { return reason_.data(); }
  CameraCounts counts() const override { return {.damaged = stats_.damaged}; }
  const V4l2Mode& mode() const noexcept { return mode_; }  // of the last Start that succeeded
  std::string Describe() const;                            // mode() in one line, for logs
  const V4l2Stats& stats() const noexcept { return stats_; }

 private:
  static constexpr std::size_t kMaxBuffers = 32;  // the kernel's own limit, VIDEO_MAX_FRAME
  struct Buffer {
    std::uint8_t* data = nullptr;
    std::size_t bytes = 0;
  };

  struct Choice;

  Errc Fail(Errc code, const char* format, ...) noexcept __attribute__((format(printf, 3, 4)));
  int Ioctl(unsigned long request, void* argument) noexcept;
  Result<> OpenDevice();
  Result<> CheckCapabilities();
  Result<> NegotiateFormat();
  Result<> TryFormat(CameraFormat wanted, v4l2_format& format);
  Result<Choice> ChooseFormat();
  Result<> RefuseFormats();
  Result<> NegotiateRate();
  Result<> KeepRateSteady();
  Result<> MapBuffers();
  Result<> StartStream();
  Result<> Queue(std::uint32_t index);
  Result<> WaitForBuffer(int timeout_ms);
  Result<> FetchNewest(v4l2_buffer& newest);
  Errc LostOr(Errc code) noexcept;
  Result<Frame> FrameOf(const v4l2_buffer& buffer);
  Result<ImageView> Unpack(const v4l2_buffer& buffer);
  Time StampOf(const v4l2_buffer& buffer) const;
  bool IsGone() noexcept;

  V4l2Config config_;
  Clock& clock_;
  SystemCalls& calls_;
  int fd_ = -1;
  bool streaming_ = false;
  InlineVector<Buffer, kMaxBuffers> buffers_;
  std::unique_ptr<jpeg::JpegDecoder> decoder_;  // while a compressed format streams
  Period period_;                               // wanted of the driver; unknown: it lists none
  int held_ = -1;                               // the buffer that the caller has, or -1
  bool counting_ = false;                       // a frame came since Start
  std::uint32_t driver_sequence_ = 0;           // of that frame
  std::uint64_t seq_ = 0;                       // the same beyond 32 bits
  V4l2Mode mode_;
  V4l2Stats stats_;
  std::array<char, 256> reason_{};
};

}  // namespace facewire::hal::v4l2

#endif  // FACEWIRE_HAL_V4L2_V4L2_CAMERA_H_
