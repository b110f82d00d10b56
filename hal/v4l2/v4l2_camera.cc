#include "hal/v4l2/v4l2_camera.h"

#include <linux/videodev2.h>
#include <poll.h>

#include <algorithm>
#include <cerrno>
#include <cstdarg>
#include <cstdio>
#include <utility>

#include "hal/posix/byte_stream.h"
#include "hal/posix/errors.h"
#include "hal/v4l2/fourcc.h"

namespace facewire::hal::v4l2 {
namespace {

// A camera that has been pulled out is closed only after this while. Its driver wakes us before it
// has taken everything down, and Linux crashes when the last close comes in between (6.1 does:
// media_device_unregister_entity reads the media device twice, without a lock the first time).
constexpr std::chrono::milliseconds kTakeDown{250};

}  // namespace

V4l2Camera::V4l2Camera(V4l2Config config, Clock& clock, SystemCalls& calls)
    : config_(std::move(config)), clock_(clock), calls_(calls) {}

V4l2Camera::~V4l2Camera() { V4l2Camera::Stop(); }

// Leaves errno alone: the caller may still want it.
Errc V4l2Camera::Fail(Errc code, const char* format, ...) noexcept {
  const int error = errno;
  const int prefix = std::snprintf(reason_.data(), reason_.size(), "%s: ", config_.device.c_str());
  if (prefix >= 0 && static_cast<std::size_t>(prefix) < reason_.size()) {
    std::va_list arguments;
    va_start(arguments, format);
    std::vsnprintf(reason_.data() + prefix, reason_.size() - static_cast<std::size_t>(prefix),
                   format, arguments);
    va_end(arguments);
  }
  errno = error;
  return code;
}

int V4l2Camera::Ioctl(unsigned long request, void* argument) noexcept {
  return Call(calls_, fd_, request, argument);
}

Result<> V4l2Camera::Start() {
  if (streaming_) return {};
  reason_[0] = '\0';
  stats_ = {};
  const bool sane = config_.width_px > 0 && config_.height_px > 0 && config_.fps > 0 &&
                    config_.fps <= 1000 && config_.buffer_count >= 2 &&
                    config_.buffer_count <= static_cast<int>(kMaxBuffers) &&
                    !config_.formats.empty();
  if (!sane) {
    return Fail(Errc::kInvalidArgument,
                "needs a size above 0, a rate up to 1000, 2 to 32 buffers and a format");
  }
  for (const auto step :
       {&V4l2Camera::OpenDevice, &V4l2Camera::CheckCapabilities, &V4l2Camera::NegotiateFormat,
        &V4l2Camera::NegotiateRate, &V4l2Camera::KeepRateSteady, &V4l2Camera::MapBuffers,
        &V4l2Camera::StartStream}) {
    if (Result<> done = (this->*step)(); !done) {
      Stop();
      return done;
    }
  }
  counting_ = false;
  seq_ = 0;
  return {};
}

void V4l2Camera::Stop() {
  if (streaming_) {
    int type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    Ioctl(VIDIOC_STREAMOFF,
          &type);  // fails when the device has gone, and then nothing streams either
  }
  streaming_ = false;
  held_ = -1;
  for (const Buffer& buffer : buffers_) calls_.Unmap(buffer.data, buffer.bytes);
  buffers_.clear();
  decoder_.reset();
  if (fd_ >= 0) calls_.Close(fd_);
  fd_ = -1;
}

Result<> V4l2Camera::Queue(std::uint32_t index) {
  v4l2_buffer buffer{};
  buffer.index = index;
  buffer.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  buffer.memory = V4L2_MEMORY_MMAP;
  if (Ioctl(VIDIOC_QBUF, &buffer) == 0) return {};
  return errno == ENODEV ? Errc::kDisconnected : Errc::kIo;
}

// Drivers disagree on what a call answers once the camera has been pulled out (ENODEV, EIO,
// EINVAL), but the kernel refuses this one for every device that is no longer there.
bool V4l2Camera::IsGone() noexcept {
  v4l2_capability capability{};
  return Ioctl(VIDIOC_QUERYCAP, &capability) != 0;
}

Errc V4l2Camera::LostOr(Errc code) noexcept {
  const int error = errno;
  const bool gone = error == ENODEV || IsGone();
  errno = error;
  return gone ? Errc::kDisconnected : code;
}

Result<> V4l2Camera::WaitForBuffer(int timeout_ms) {
  short ready = 0;
  const int count = calls_.PollReadable(fd_, timeout_ms, &ready);
  if (count == 0) return Errc::kTimeout;
  if (count < 0) {
    if (errno == EINTR) return Errc::kNotReady;
    return Fail(Errc::kIo, "cannot be waited for");
  }
  if ((ready & POLLIN) != 0) return {};
  return Fail(LostOr(Errc::kIo), "stopped streaming by itself");
}

// Takes out every filled buffer and keeps the newest good one. kNotReady when there is none.
Result<> V4l2Camera::FetchNewest(v4l2_buffer& newest) {
  bool have = false;
  for (;;) {
    v4l2_buffer buffer{};
    buffer.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    buffer.memory = V4L2_MEMORY_MMAP;
    if (Ioctl(VIDIOC_DQBUF, &buffer) != 0) {
      if (errno == EAGAIN) break;
      const Errc code = LostOr(Errc::kIo);
      // A frame in hand is worth more than the news: the next call tells it again.
      if (have && code != Errc::kDisconnected) break;
      return Fail(code, "gives no frame: error %d", errno);
    }
    if (buffer.index >= buffers_.size()) return Fail(Errc::kIo, "gave a buffer that it never had");
    std::uint32_t back = buffer.index;
    const bool damaged = (buffer.flags & V4L2_BUF_FLAG_ERROR) != 0 ||
                         (!decoder_ && buffer.bytesused < mode_.layout.bytes);
    if (damaged) {
      ++stats_.damaged;
    } else {
      if (have) ++stats_.superseded;
      back = have ? newest.index : buffer.index;
      newest = buffer;
      if (!have) {
        have = true;
        continue;
      }
    }
    if (Result<> queued = Queue(back); !queued) {
      return Fail(LostOr(queued.error()), "does not take its buffer back: error %d", errno);
    }
  }
  return have ? Result<>{} : Errc::kNotReady;
}

Result<Frame> V4l2Camera::Acquire(std::chrono::milliseconds timeout) {
  if (!streaming_) return Errc::kDisconnected;  // and the reason stays what it was
  reason_[0] = '\0';
  const posix::Deadline deadline(timeout);
  const std::uint64_t damaged_before = stats_.damaged;
  for (;;) {
    v4l2_buffer buffer{};
    Result<> got = WaitForBuffer(deadline.remaining_ms());
    if (got) got = FetchNewest(buffer);
    Result<Frame> frame = got ? FrameOf(buffer) : got.error();
    if (frame) return frame;
    if (frame.error() == Errc::kDisconnected) {
      Fail(Errc::kDisconnected, "the camera has gone");
      clock_.SleepUntil(clock_.Now() + kTakeDown);
      Stop();
    }
    // Interrupted, or only damaged frames so far. A deadline that has passed ends it here too,
    // because a signal may come before every wait.
    if (frame.error() == Errc::kNotReady && !deadline.passed()) continue;
    if (frame.error() != Errc::kNotReady && frame.error() != Errc::kTimeout) return frame;
    if (stats_.damaged == damaged_before) return Errc::kTimeout;
    return Fail(Errc::kTimeout, "sends only damaged pictures");
  }
}

// kNotReady: it holds no whole picture, and went back.
Result<Frame> V4l2Camera::FrameOf(const v4l2_buffer& buffer) {
  ImageView image = mode_.layout.At(buffers_[buffer.index].data);
  if (decoder_) {
    const Result<ImageView> unpacked = Unpack(buffer);
    if (!unpacked) return unpacked.error();
    image = *unpacked;
  } else {
    held_ = static_cast<int>(buffer.index);
  }
  // The driver counts in 32 bits and from any number. One that repeats itself does not count, and
  // one that goes back has begun anew: both leave the frame as the next one.
  constexpr std::uint32_t kBackwards = 0x80000000U;
  const std::uint32_t step = buffer.sequence - driver_sequence_;
  if (counting_) seq_ += step == 0 || step >= kBackwards ? 1 : step;
  driver_sequence_ = buffer.sequence;
  counting_ = true;
  ++stats_.frames;
  return Frame{.seq = seq_, .captured = StampOf(buffer), .image = image};
}

// The picture goes to the decoder's memory, and the buffer back to the driver at once.
Result<ImageView> V4l2Camera::Unpack(const v4l2_buffer& buffer) {
  const Buffer& packed = buffers_[buffer.index];
  const std::size_t bytes = std::min<std::size_t>(buffer.bytesused, packed.bytes);
  const Result<ImageView> image = decoder_->Decode({packed.data, bytes});
  if (Result<> queued = Queue(buffer.index); !queued) {
    return Fail(LostOr(queued.error()), "does not take its buffer back: error %d", errno);
  }
  if (image) return image;
  ++stats_.damaged;
  return Errc::kNotReady;
}

Time V4l2Camera::StampOf(const v4l2_buffer& buffer) const {
  const bool monotonic =
      (buffer.flags & V4L2_BUF_FLAG_TIMESTAMP_MASK) == V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC;
  const Time stamp{std::chrono::seconds(buffer.timestamp.tv_sec) +
                   std::chrono::microseconds(buffer.timestamp.tv_usec)};
  return monotonic && stamp > Time{} ? stamp : clock_.Now();
}

void V4l2Camera::Release(const Frame& /*frame*/) {
  if (held_ < 0) return;
  // A refusal means that the device has gone: the next Acquire finds that out and says so.
  static_cast<void>(Queue(static_cast<std::uint32_t>(held_)));
  held_ = -1;
}

std::string V4l2Camera::Describe() const {
  std::array<char, 192> text;
  const ImageView& view = mode_.layout.view;
  std::snprintf(text.data(), text.size(), "%s (%s): %s %dx%d%s", mode_.card.data(),
                mode_.driver.data(), FourccText(FourccOf(mode_.format)).data(), view.width_px,
                view.height_px, mode_.fps > 0 ? "" : " at an unknown rate");
  std::string line = text.data();
  if (mode_.fps > 0) {
    std::snprintf(text.data(), text.size(), " at %.4g fps", mode_.fps);
    line += text.data();
  }
  return line + ", " + std::to_string(mode_.buffer_count) + " buffers";
}

}  // namespace facewire::hal::v4l2
