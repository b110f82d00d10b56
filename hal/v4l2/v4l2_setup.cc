// The steps of V4l2Camera::Start, in their order.

#include <fcntl.h>
#include <linux/videodev2.h>
#include <sys/mman.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <utility>

#include "hal/posix/errors.h"
#include "hal/v4l2/fourcc.h"
#include "hal/v4l2/v4l2_camera.h"

namespace facewire::hal::v4l2 {
namespace {

constexpr int kFewestBuffers = 2;  // one with the caller, one for the driver to fill
constexpr std::uint32_t kMostListed =
    64;  // formats asked for: a driver that never ends is no reason to hang

template <std::size_t N, std::size_t M>
void CopyText(std::array<char, N>& to, const std::uint8_t (&from)[M]) noexcept {
  static_assert(N >= M);
  std::memcpy(to.data(), from, M);
  to[M - 1] = '\0';
}

bool IsProgressive(std::uint32_t field) noexcept {
  return field == V4L2_FIELD_NONE || field == V4L2_FIELD_ANY;
}

YuvEncoding EncodingOf(const v4l2_pix_format& pix) noexcept {
  std::uint32_t range = pix.quantization;
  if (range == V4L2_QUANTIZATION_DEFAULT) {
    range = V4L2_MAP_QUANTIZATION_DEFAULT(false, pix.colorspace, pix.ycbcr_enc);
  }
  return range == V4L2_QUANTIZATION_FULL_RANGE ? YuvEncoding::kBt601Full
                                               : YuvEncoding::kBt601Limited;
}

}  // namespace

Result<> V4l2Camera::OpenDevice() {
  do {
    fd_ = calls_.Open(config_.device.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
  } while (fd_ < 0 && errno == EINTR);
  if (fd_ >= 0) return {};
  const int error = errno;
  const Errc code = posix::OpenError(error);
  switch (code) {
    case Errc::kNotFound:
      return Fail(code, "there is no such device");
    case Errc::kPermission:
      return Fail(code, "no permission: the user must be in the group 'video'");
    case Errc::kBusy:
      return Fail(code, "another program is using the camera");
    default:
      return Fail(code, "cannot be opened: %s", std::strerror(error));
  }
}

Result<> V4l2Camera::CheckCapabilities() {
  v4l2_capability capability{};
  if (Ioctl(VIDIOC_QUERYCAP, &capability) != 0) {
    if (errno == ENODEV) return Fail(Errc::kNotFound, "the camera has just gone");
    return Fail(Errc::kUnsupported, "not a video device");
  }
  CopyText(mode_.driver, capability.driver);
  CopyText(mode_.card, capability.card);
  // A device of several nodes tells in device_caps what this one can do.
  const std::uint32_t can = (capability.capabilities & V4L2_CAP_DEVICE_CAPS) != 0
                                ? capability.device_caps
                                : capability.capabilities;
  if ((can & V4L2_CAP_VIDEO_CAPTURE) == 0) {
    if ((can & V4L2_CAP_VIDEO_CAPTURE_MPLANE) != 0) {
      return Fail(Errc::kUnsupported, "%s captures only into several planes", mode_.card.data());
    }
    return Fail(Errc::kUnsupported,
                "this node of %s captures no pictures; a camera's next node often does",
                mode_.card.data());
  }
  if ((can & V4L2_CAP_STREAMING) == 0) {
    return Fail(Errc::kUnsupported, "%s cannot stream into mapped memory", mode_.card.data());
  }
  return {};
}

Result<> V4l2Camera::TryFormat(CameraFormat wanted, v4l2_format& format) {
  format = {};
  format.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  format.fmt.pix.width = static_cast<std::uint32_t>(config_.width_px);
  format.fmt.pix.height = static_cast<std::uint32_t>(config_.height_px);
  format.fmt.pix.pixelformat = FourccOf(wanted);
  format.fmt.pix.field = V4L2_FIELD_NONE;
  if (Ioctl(VIDIOC_S_FMT, &format) != 0) {
    if (errno == EBUSY) return Fail(Errc::kBusy, "another program is using the camera");
    if (errno == ENODEV) return Fail(Errc::kNotFound, "the camera has just gone");
    return Errc::kUnsupported;
  }
  // Drivers put another format in the place of one that they do not have.
  return format.fmt.pix.pixelformat == FourccOf(wanted) ? Result<>{} : Errc::kUnsupported;
}

// What a device makes of one of the formats.
struct V4l2Camera::Choice {
  CameraFormat format{};
  v4l2_format device{};
  Period period{};

  int SizeError(const V4l2Config& wanted) const noexcept {
    return std::abs(static_cast<int>(device.fmt.pix.width) - wanted.width_px) +
           std::abs(static_cast<int>(device.fmt.pix.height) - wanted.height_px);
  }
  // How much of the wanted rate is missing, 0..1. A rate that nobody knows counts as enough.
  double RateError(const V4l2Config& wanted) const noexcept {
    constexpr double kNextTo = 0.05;  // 29.97 is 30, and 25 is not
    const double fps = period.fps();
    const double missing = fps > 0 ? 1 - fps / wanted.fps : 0;
    return missing > kNextTo ? missing : 0;
  }
};

Result<V4l2Camera::Choice> V4l2Camera::ChooseFormat() {
  Choice best;
  bool any = false;
  for (const CameraFormat format : config_.formats) {
    Choice choice{.format = format};
    if (Result<> tried = TryFormat(format, choice.device); !tried) {
      if (tried.error() != Errc::kUnsupported) return tried.error();
      continue;
    }
    const v4l2_pix_format& pix = choice.device.fmt.pix;
    choice.period =
        ReadFrameRates(calls_, fd_, pix.pixelformat, pix.width, pix.height).Nearest(config_.fps);
    const auto errors = [this](const Choice& of) {
      return std::pair(of.SizeError(config_), of.RateError(config_));
    };
    if (!any || errors(choice) < errors(best)) best = choice;
    any = true;
    if (errors(best) == std::pair(0, 0.0)) return best;  // and the device stands at it
  }
  if (!any) return RefuseFormats().error();
  if (Result<> again = TryFormat(best.format, best.device); !again) {
    return Fail(again.error(), "refuses the format that it offered before");
  }
  return best;
}

Result<> V4l2Camera::NegotiateFormat() {
  const Result<Choice> choice = ChooseFormat();
  if (!choice) return choice.error();
  const v4l2_pix_format& pix = choice->device.fmt.pix;
  if (!IsProgressive(pix.field)) {
    return Fail(Errc::kUnsupported, "delivers interlaced pictures; a progressive mode is needed");
  }
  const bool compressed = choice->format == CameraFormat::kMjpeg;
  const Result<PixelLayout> layout =
      LayOut(PixelFormatOf(choice->format), static_cast<int>(pix.width),
             static_cast<int>(pix.height), compressed ? 0 : pix.bytesperline);
  if (!layout || (!compressed && pix.sizeimage < layout->bytes)) {
    return Fail(Errc::kUnsupported,
                "%ux%u %s with rows of %u bytes and pictures of %u contradicts itself", pix.width,
                pix.height, FourccText(pix.pixelformat).data(), pix.bytesperline, pix.sizeimage);
  }
  if (compressed) {
    decoder_ = std::make_unique<jpeg::JpegDecoder>(layout->view.width_px, layout->view.height_px);
  }
  mode_.format = choice->format;
  mode_.layout = *layout;
  mode_.layout.view.encoding = EncodingOf(pix);
  period_ = choice->period;
  return {};
}

// Names what the device does offer.
Result<> V4l2Camera::RefuseFormats() {
  std::string offered;
  for (std::uint32_t i = 0; i < kMostListed; ++i) {
    v4l2_fmtdesc description{};
    description.index = i;
    description.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    if (Ioctl(VIDIOC_ENUM_FMT, &description) != 0) break;
    if (i > 0) offered += ", ";
    offered += FourccText(description.pixelformat).data();
  }
  std::string wanted;
  for (const CameraFormat format : config_.formats) {
    if (!wanted.empty()) wanted += ", ";
    wanted += FourccText(FourccOf(format)).data();
  }
  return Fail(Errc::kUnsupported, "%s offers only %s; one of %s is needed", mode_.card.data(),
              offered.empty() ? "no format" : offered.c_str(), wanted.c_str());
}

Result<> V4l2Camera::NegotiateRate() {
  mode_.fps = 0;
  v4l2_streamparm parameters{};
  parameters.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  if (Ioctl(VIDIOC_G_PARM, &parameters) != 0) return {};  // a driver without rates runs as it will
  if ((parameters.parm.capture.capability & V4L2_CAP_TIMEPERFRAME) != 0) {
    v4l2_streamparm wanted{};
    wanted.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    const bool listed = period_.denominator != 0;
    wanted.parm.capture.timeperframe.numerator = listed ? period_.numerator : 1000;
    wanted.parm.capture.timeperframe.denominator =
        listed ? period_.denominator : static_cast<std::uint32_t>(std::lround(1000 * config_.fps));
    // Refused: the camera keeps the rate it has, and that one is judged.
    if (Ioctl(VIDIOC_S_PARM, &wanted) == 0) parameters = wanted;
  }
  const v4l2_fract period = parameters.parm.capture.timeperframe;
  if (period.numerator == 0 || period.denominator == 0) return {};
  mode_.fps = static_cast<double>(period.denominator) / period.numerator;
  if (mode_.fps >= config_.lowest_fps) return {};
  return Fail(Errc::kUnsupported,
              "gives only %.3g frames a second at %dx%d; at least %.3g are needed: ask for a "
              "smaller picture",
              mode_.fps, mode_.layout.view.width_px, mode_.layout.view.height_px,
              config_.lowest_fps);
}

// In the dark, webcams expose longer than a frame lasts and halve their rate, unless they are told
// not to. A camera that cannot be told keeps the manners it has.
Result<> V4l2Camera::KeepRateSteady() {
  v4l2_control rate_over_light{.id = V4L2_CID_EXPOSURE_AUTO_PRIORITY, .value = 0};
  static_cast<void>(Ioctl(VIDIOC_S_CTRL, &rate_over_light));
  return {};
}

Result<> V4l2Camera::MapBuffers() {
  v4l2_requestbuffers request{};
  request.count = static_cast<std::uint32_t>(config_.buffer_count);
  request.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  request.memory = V4L2_MEMORY_MMAP;
  if (Ioctl(VIDIOC_REQBUFS, &request) != 0) {
    if (errno == EBUSY) return Fail(Errc::kBusy, "another program is using the camera");
    return Fail(Errc::kUnsupported, "gives no mapped buffers: %s", std::strerror(errno));
  }
  if (request.count < kFewestBuffers) {
    return Fail(Errc::kUnsupported, "gives %u buffers; at least %d are needed", request.count,
                kFewestBuffers);
  }
  const std::uint32_t count = std::min<std::uint32_t>(request.count, kMaxBuffers);
  for (std::uint32_t i = 0; i < count; ++i) {
    v4l2_buffer buffer{};
    buffer.index = i;
    buffer.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    buffer.memory = V4L2_MEMORY_MMAP;
    if (Ioctl(VIDIOC_QUERYBUF, &buffer) != 0) {
      return Fail(LostOr(Errc::kIo), "does not describe buffer %u: %s", i, std::strerror(errno));
    }
    if (!decoder_ && buffer.length < mode_.layout.bytes) {
      return Fail(Errc::kUnsupported, "has buffers of %u bytes for pictures of %zu", buffer.length,
                  mode_.layout.bytes);
    }
    void* at = calls_.Map(buffer.length, fd_, buffer.m.offset);
    if (at == MAP_FAILED) {
      return Fail(Errc::kIo, "buffer %u cannot be mapped: %s", i, std::strerror(errno));
    }
    static_cast<void>(buffers_.try_push(  // count is at most the capacity
        {.data = static_cast<std::uint8_t*>(at), .bytes = buffer.length}));
    if (Result<> queued = Queue(i); !queued) {
      return Fail(queued.error(), "does not take buffer %u: %s", i, std::strerror(errno));
    }
  }
  mode_.buffer_count = static_cast<int>(count);
  return {};
}

Result<> V4l2Camera::StartStream() {
  int type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  if (Ioctl(VIDIOC_STREAMON, &type) == 0) {
    streaming_ = true;
    return {};
  }
  switch (errno) {
    case EBUSY:
      return Fail(Errc::kBusy, "another program is using the camera");
    case ENOSPC:
      return Fail(Errc::kBusy,
                  "the USB bus has no room for this picture: use a smaller one or another port");
    case ENODEV:
      return Fail(Errc::kNotFound, "the camera has just gone");
    default:
      return Fail(Errc::kIo, "does not start to stream: %s", std::strerror(errno));
  }
}

}  // namespace facewire::hal::v4l2
