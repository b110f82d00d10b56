#include "tests/hal/v4l2/fake_kernel.h"

#include <poll.h>
#include <sys/mman.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <utility>

namespace facewire::hal::v4l2 {

int FakeKernel::No(int error) {
  errno = error;
  return -1;
}

bool FakeKernel::Interrupts() {
  if (!interrupted) return false;
  interrupt_next_ = !interrupt_next_;
  return !interrupt_next_;
}

int FakeKernel::Open(const char* path, int /*flags*/) {
  if (Interrupts()) return No(EINTR);
  const auto link = links.find(path);
  if ((link != links.end() ? link->second : path) != node || !present) return No(ENOENT);
  if (open_error != 0) return No(open_error);
  ++open_files_;
  return kFd;
}

int FakeKernel::Close(int fd) {
  if (fd != kFd || open_files_ == 0) return No(EBADF);
  --open_files_;
  streaming_ = false;
  queued_.clear();
  filled_.clear();
  return 0;
}

int FakeKernel::Ioctl(int fd, unsigned long request, void* argument) {
  if (fd != kFd || open_files_ == 0) return No(EBADF);
  if (Interrupts()) return No(EINTR);
  if (!present) return No(ENODEV);
  if (!is_video_device) return No(ENOTTY);
  switch (request) {
    case VIDIOC_QUERYCAP: {
      auto& capability = *static_cast<v4l2_capability*>(argument);
      std::strcpy(reinterpret_cast<char*>(capability.driver), "fake");
      std::strcpy(reinterpret_cast<char*>(capability.card), "Fake Camera");
      capability.capabilities = device_caps | V4L2_CAP_DEVICE_CAPS | V4L2_CAP_VIDEO_OUTPUT;
      capability.device_caps = device_caps;
      return 0;
    }
    case VIDIOC_ENUM_FMT:
      return ListFormat(*static_cast<v4l2_fmtdesc*>(argument));
    case VIDIOC_ENUM_FRAMESIZES:
      return ListSize(*static_cast<v4l2_frmsizeenum*>(argument));
    case VIDIOC_ENUM_FRAMEINTERVALS:
      return ListRate(*static_cast<v4l2_frmivalenum*>(argument));
    case VIDIOC_S_CTRL:
      return SetControl(*static_cast<const v4l2_control*>(argument));
    case VIDIOC_S_FMT:
      return SetFormat(*static_cast<v4l2_format*>(argument));
    case VIDIOC_G_PARM:
      return Rate(*static_cast<v4l2_streamparm*>(argument), false);
    case VIDIOC_S_PARM:
      return Rate(*static_cast<v4l2_streamparm*>(argument), true);
    case VIDIOC_REQBUFS:
      return RequestBuffers(*static_cast<v4l2_requestbuffers*>(argument));
    case VIDIOC_QUERYBUF:
      return QueryBuffer(*static_cast<v4l2_buffer*>(argument));
    case VIDIOC_QBUF:
      return QueueBuffer(*static_cast<const v4l2_buffer*>(argument));
    case VIDIOC_DQBUF:
      return DequeueBuffer(*static_cast<v4l2_buffer*>(argument));
    case VIDIOC_STREAMON:
      if (stream_error != 0) return No(stream_error);
      if (memory_.empty()) return No(EINVAL);
      streaming_ = true;
      return 0;
    case VIDIOC_STREAMOFF:
      streaming_ = false;
      queued_.clear();
      filled_.clear();
      return 0;
    default:
      return No(ENOTTY);
  }
}

int FakeKernel::ListFormat(v4l2_fmtdesc& description) const {
  std::vector<std::uint32_t> formats;
  for (const FakeMode& mode : modes) {
    if (std::ranges::find(formats, mode.fourcc) == formats.end()) formats.push_back(mode.fourcc);
  }
  if (description.index >= formats.size()) return No(EINVAL);
  description.pixelformat = formats[description.index];
  return 0;
}

int FakeKernel::ListSize(v4l2_frmsizeenum& size) const {
  std::uint32_t index = 0;
  for (const FakeMode& mode : modes) {
    if (mode.fourcc != size.pixel_format || index++ != size.index) continue;
    size.type = V4L2_FRMSIZE_TYPE_DISCRETE;
    size.discrete = {.width = mode.width, .height = mode.height};
    return 0;
  }
  return No(EINVAL);
}

int FakeKernel::ListRate(v4l2_frmivalenum& rate) const {
  for (const FakeMode& mode : modes) {
    if (mode.fourcc != rate.pixel_format || mode.width != rate.width ||
        mode.height != rate.height) {
      continue;
    }
    if (rate.index >= (mode.range ? 1 : mode.rates.size())) break;
    if (mode.range) {
      rate.type = V4L2_FRMIVAL_TYPE_CONTINUOUS;
      rate.stepwise.min = {.numerator = 1, .denominator = mode.rates[0]};
      rate.stepwise.max = {.numerator = 1, .denominator = mode.rates[1]};
    } else {
      rate.type = V4L2_FRMIVAL_TYPE_DISCRETE;
      rate.discrete = {.numerator = 1, .denominator = mode.rates[rate.index]};
    }
    return 0;
  }
  return No(EINVAL);
}

int FakeKernel::SetControl(const v4l2_control& control) {
  const auto found = controls.find(control.id);
  if (found == controls.end()) return No(EINVAL);
  found->second = control.value;
  return 0;
}

// As drivers do: an unknown format becomes the first one, an unknown size the nearest of the
// format.
int FakeKernel::SetFormat(v4l2_format& format) {
  if (format_error != 0) return No(format_error);
  v4l2_pix_format& pix = format.fmt.pix;
  const auto of_format = [&pix](const FakeMode& mode) { return mode.fourcc == pix.pixelformat; };
  if (std::ranges::none_of(modes, of_format)) pix.pixelformat = modes.front().fourcc;
  const auto distance = [&pix](const FakeMode& mode) {
    return std::abs(static_cast<double>(mode.width) - pix.width) +
           std::abs(static_cast<double>(mode.height) - pix.height);
  };
  const FakeMode* nearest = &modes.front();
  for (const FakeMode& mode : modes) {
    if (!of_format(mode)) continue;
    if (!of_format(*nearest) || distance(mode) < distance(*nearest)) nearest = &mode;
  }
  mode_ = *nearest;
  pix.width = mode_.width;
  pix.height = mode_.height;
  pix.bytesperline = mode_.bytesperline;
  pix.sizeimage = mode_.sizeimage;
  pix.field = field;
  pix.colorspace = colorspace;
  pix.quantization = quantization;
  return 0;
}

int FakeKernel::Rate(v4l2_streamparm& parameters, bool set) {
  if (!has_rate) return No(ENOTTY);
  const std::vector<std::uint32_t>& has = mode_.rates.empty() ? rates : mode_.rates;
  v4l2_captureparm& capture = parameters.parm.capture;
  if (set) {
    if (rate_error != 0) return No(rate_error);
    const double wanted =
        static_cast<double>(capture.timeperframe.denominator) / capture.timeperframe.numerator;
    rate_ = wanted;
    if (!mode_.range) {
      rate_ = *std::ranges::min_element(has, {},
                                        [wanted](double rate) { return std::abs(rate - wanted); });
    }
  } else {
    rate_ = has.front();
  }
  capture.capability = rate_is_settable ? V4L2_CAP_TIMEPERFRAME : 0;
  capture.timeperframe = {.numerator = 1000,
                          .denominator = static_cast<std::uint32_t>(std::lround(1000 * rate_))};
  return 0;
}

int FakeKernel::RequestBuffers(v4l2_requestbuffers& request) {
  if (buffers_error != 0) return No(buffers_error);
  if (request.memory != V4L2_MEMORY_MMAP) return No(EINVAL);
  request.count = std::min(request.count, most_buffers);
  const std::uint32_t bytes = buffer_bytes != 0 ? buffer_bytes : mode_.sizeimage;
  memory_.assign(request.count, std::vector<std::uint8_t>(bytes));
  return 0;
}

int FakeKernel::QueryBuffer(v4l2_buffer& buffer) {
  if (buffer.index >= memory_.size()) return No(EINVAL);
  buffer.length = static_cast<std::uint32_t>(memory_[buffer.index].size());
  buffer.m.offset = buffer.index * 4096;
  return 0;
}

int FakeKernel::QueueBuffer(const v4l2_buffer& buffer) {
  if (buffer.index >= memory_.size()) return No(EINVAL);
  if (std::ranges::find(queued_, buffer.index) != queued_.end()) return No(EINVAL);
  queued_.push_back(buffer.index);
  return 0;
}

int FakeKernel::DequeueBuffer(v4l2_buffer& buffer) {
  if (!streaming_) return No(EINVAL);
  if (dequeue_error != 0) return No(dequeue_error);
  if (filled_.empty()) return No(EAGAIN);
  buffer = filled_.front();
  filled_.pop_front();
  return 0;
}

void* FakeKernel::Map(std::size_t length, int fd, std::size_t offset) {
  const std::size_t index = offset / 4096;
  if (fd != kFd || index >= memory_.size() || memory_[index].size() != length) {
    errno = EINVAL;
    return MAP_FAILED;
  }
  ++maps_;
  return memory_[index].data();
}

int FakeKernel::Unmap(void* at, std::size_t length) {
  const bool known = std::ranges::any_of(memory_, [at, length](const auto& memory) {
    return memory.data() == at && memory.size() == length;
  });
  if (!known) return No(EINVAL);
  --maps_;
  return 0;
}

int FakeKernel::PollReadable(int fd, int /*timeout_ms*/, short* revents) {
  ++polls_;
  if (fd != kFd) return No(EBADF);
  if (Interrupts()) return No(EINTR);
  *revents = 0;
  if (filled_.empty() && on_empty_poll) std::exchange(on_empty_poll, nullptr)();
  if (!present) {
    *revents = POLLERR | POLLHUP;
  } else if (!streaming_) {
    *revents = POLLERR;
  } else if (!filled_.empty() || dequeue_error != 0) {
    *revents = POLLIN;
  }
  return *revents != 0 ? 1 : 0;  // nothing: the time-out has passed
}

bool FakeKernel::Capture(std::uint32_t sequence, std::int64_t stamp_us, std::uint8_t value,
                         std::uint32_t flags, bool whole) {
  if (!streaming_ || queued_.empty()) return false;
  v4l2_buffer buffer{};
  buffer.index = queued_.front();
  queued_.pop_front();
  std::vector<std::uint8_t>& memory = memory_[buffer.index];
  std::ranges::fill(memory, value);
  buffer.bytesused = whole ? mode_.sizeimage : mode_.sizeimage - 1;
  buffer.flags = flags;
  Fill(buffer, sequence, stamp_us);
  return true;
}

bool FakeKernel::CaptureJpeg(std::uint32_t sequence, std::int64_t stamp_us,
                             const std::vector<std::uint8_t>& jpeg) {
  if (!streaming_ || queued_.empty()) return false;
  v4l2_buffer buffer{};
  buffer.index = queued_.front();
  queued_.pop_front();
  std::vector<std::uint8_t>& memory = memory_[buffer.index];
  buffer.bytesused = static_cast<std::uint32_t>(jpeg.size());
  std::copy_n(jpeg.begin(), std::min(jpeg.size(), memory.size()), memory.begin());
  Fill(buffer, sequence, stamp_us);
  return true;
}

void FakeKernel::Fill(v4l2_buffer buffer, std::uint32_t sequence, std::int64_t stamp_us) {
  buffer.flags |= stamps;
  buffer.sequence = sequence;
  buffer.timestamp.tv_sec = stamp_us / 1'000'000;
  buffer.timestamp.tv_usec = stamp_us % 1'000'000;
  filled_.push_back(buffer);
}

void FakeKernel::Unplug() {
  present = false;
  streaming_ = false;
  queued_.clear();
  filled_.clear();
}

}  // namespace facewire::hal::v4l2
