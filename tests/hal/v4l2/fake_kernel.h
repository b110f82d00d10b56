#ifndef FACEWIRE_TESTS_HAL_V4L2_FAKE_KERNEL_H_
#define FACEWIRE_TESTS_HAL_V4L2_FAKE_KERNEL_H_

#include <linux/videodev2.h>

#include <array>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "hal/v4l2/system_calls.h"

namespace facewire::hal::v4l2 {

// One picture size of one format that the fake device has.
struct FakeMode {
  std::uint32_t fourcc = V4L2_PIX_FMT_YUYV;
  std::uint32_t width = 640;
  std::uint32_t height = 480;
  std::uint32_t bytesperline = 0;
  std::uint32_t sizeimage = 0;
  std::vector<std::uint32_t> rates = {};  // in Hz, as listed; empty: not listed
  bool range = false;                     // rates are the fastest and the slowest of a range
};

// A capture device with the kernel's manners: what one call leaves behind the next one sees, and
// calls in the wrong order are refused. Public members are the knobs.
class FakeKernel final : public SystemCalls {
 public:
  static constexpr const char* kPath = "/dev/video7";

  std::string node = kPath;                  // of the device; a replug may give it another
  std::map<std::string, std::string> links;  // to nodes, as udev makes them
  bool present = true;
  bool interrupted = false;  // every call fails once with EINTR before it does its work
  int open_error = 0;        // errno of Open, 0: none
  std::uint32_t device_caps = V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_STREAMING;
  bool is_video_device = true;
  std::vector<FakeMode> modes = {Packed(V4L2_PIX_FMT_YUYV, 640, 480, 2)};
  std::uint32_t field = V4L2_FIELD_NONE;
  std::uint32_t colorspace = V4L2_COLORSPACE_SRGB;
  std::uint32_t quantization = V4L2_QUANTIZATION_DEFAULT;
  int format_error = 0;  // errno of S_FMT
  bool has_rate = true;  // G_PARM works
  bool rate_is_settable = true;
  int rate_error = 0;                           // errno of S_PARM
  std::vector<std::uint32_t> rates = {30, 15};  // of modes that list none
  std::map<std::uint32_t, int> controls;        // those that it has, by V4L2_CID_...
  int buffers_error = 0;                        // errno of REQBUFS
  std::uint32_t most_buffers = 32;
  std::uint32_t buffer_bytes = 0;  // 0: the mode's sizeimage
  int stream_error = 0;            // errno of STREAMON
  int dequeue_error = 0;           // errno of DQBUF, with the device still there
  std::uint32_t stamps = V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC;

  static FakeMode Mjpeg(std::uint32_t width, std::uint32_t height) {
    return {V4L2_PIX_FMT_MJPEG, width, height, 0, width * height};
  }
  static FakeMode Packed(std::uint32_t fourcc, std::uint32_t width, std::uint32_t height,
                         std::uint32_t bytes_per_pixel) {
    return {fourcc, width, height, width * bytes_per_pixel, width * height * bytes_per_pixel};
  }
  static FakeMode Planar(std::uint32_t fourcc, std::uint32_t width, std::uint32_t height) {
    return {fourcc, width, height, width, width * height * 3 / 2};
  }

  // Called once, when a wait finds nothing, before it answers: what happens while the camera waits.
  std::function<void()> on_empty_poll;

  // The sensor delivers a picture whose every byte is `value`. False when no buffer is free.
  bool Capture(std::uint32_t sequence, std::int64_t stamp_us, std::uint8_t value,
               std::uint32_t flags = 0, bool whole = true);
  // One of compressed bytes.
  bool CaptureJpeg(std::uint32_t sequence, std::int64_t stamp_us,
                   const std::vector<std::uint8_t>& jpeg);
  void Unplug();

  // What is left behind: 0 after everything was given back.
  int open_files() const { return open_files_; }
  int maps() const { return maps_; }
  std::size_t queued() const { return queued_.size(); }
  bool streaming() const { return streaming_; }
  int polls() const { return polls_; }

  int Open(const char* path, int flags) override;
  int Close(int fd) override;
  int Ioctl(int fd, unsigned long request, void* argument) override;
  void* Map(std::size_t length, int fd, std::size_t offset) override;
  int Unmap(void* at, std::size_t length) override;
  int PollReadable(int fd, int timeout_ms, short* revents) override;

 private:
  static constexpr int kFd = 1000;
  static int No(int error);
  bool Interrupts();
  int SetFormat(v4l2_format& format);
  int ListFormat(v4l2_fmtdesc& description) const;
  int ListSize(v4l2_frmsizeenum& size) const;
  int ListRate(v4l2_frmivalenum& rate) const;
  int SetControl(const v4l2_control& control);
  int Rate(v4l2_streamparm& parameters, bool set);
  int RequestBuffers(v4l2_requestbuffers& request);
  int QueryBuffer(v4l2_buffer& buffer);
  int QueueBuffer(const v4l2_buffer& buffer);
  int DequeueBuffer(v4l2_buffer& buffer);
  void Fill(v4l2_buffer buffer, std::uint32_t sequence, std::int64_t stamp_us);

  bool interrupt_next_ = true;
  int open_files_ = 0;
  int maps_ = 0;
  int polls_ = 0;
  bool streaming_ = false;
  FakeMode mode_;
  double rate_ = 30;
  std::vector<std::vector<std::uint8_t>> memory_;
  std::deque<std::uint32_t> queued_;
  std::deque<v4l2_buffer> filled_;
};

}  // namespace facewire::hal::v4l2

#endif  // FACEWIRE_TESTS_HAL_V4L2_FAKE_KERNEL_H_
