#include "hal/libcamera/libcamera_camera.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <utility>

namespace facewire::hal::libcamera {

using Steady = std::chrono::steady_clock;

LibcameraCamera::LibcameraCamera(LibcameraConfig config, Clock& clock,
                                 std::unique_ptr<Session> session)
    : config_(std::move(config)),
      clock_(clock),
      session_(std::move(session)),
      gone_("libcamera:" + config_.camera + ": the camera has gone"),
      damaged_("libcamera:" + config_.camera + ": sends only damaged pictures") {}

LibcameraCamera::~LibcameraCamera() { LibcameraCamera::Stop(); }

Result<> LibcameraCamera::Fail(Errc code, std::string_view why) {
  refusal_ = "libcamera:" + config_.camera + ": ";
  refusal_ += why;
  reason_ = refusal_;
  return code;
}

Result<> LibcameraCamera::Start() {
  reason_ = {};
  if (running_) return {};
  const bool sane = config_.width_px > 0 && config_.height_px > 0 && config_.fps > 0 &&
                    config_.fps <= 1000 && config_.buffer_count >= 2 &&
                    config_.buffer_count <= static_cast<int>(kMaxBuffers) &&
                    !config_.formats.empty() && !config_.camera.empty();
  if (!sane) {
    return Fail(Errc::kInvalidArgument,
                "needs a camera, a size above 0, a rate up to 1000, 2 to 16 buffers and a format");
  }
  hand_over_.Reset();
  count_.Reset();
  counts_ = {};
  const Result<Negotiated> opened = session_->Open(config_, hand_over_);
  if (!opened) return Fail(opened.error(), session_->reason());
  negotiated_ = *opened;
  if (Result<> prepared = Prepare(); !prepared) {
    session_->Close();
    return prepared;
  }
  running_ = true;
  return {};
}

// Everything that reading pictures takes, so that Acquire allocates nothing.
Result<> LibcameraCamera::Prepare() {
  const Mode& mode = negotiated_.mode;
  decoder_.reset();
  layout_ = {};
  if (mode.format == CameraFormat::kMjpeg) {
    decoder_.emplace(mode.width_px, mode.height_px);
    return {};
  }
  const Result<PixelLayout> layout =
      LayOut(PixelFormatOf(mode.format), mode.width_px, mode.height_px, negotiated_.stride_bytes);
  bool fits = layout.has_value();
  for (const MappedBuffer& buffer : session_->buffers()) {
    fits = fits && buffer.View(*layout).has_value();
  }
  if (!fits) {
    return Fail(Errc::kUnsupported,
                negotiated_.id + " contradicts itself: " + libcamera::Describe(mode) +
                    " with rows of " + std::to_string(negotiated_.stride_bytes) +
                    " bytes does not fit into its buffers");
  }
  layout_ = *layout;
  layout_.view.encoding = negotiated_.yuv;
  return {};
}

void LibcameraCamera::Stop() {
  if (!running_) return;
  if (held_ >= 0) session_->buffers()[static_cast<std::size_t>(held_)].EndRead();
  held_ = -1;
  running_ = false;
  session_->Close();
}

bool LibcameraCamera::IsWhole(const Completion& completion) const noexcept {
  if (!completion.whole) return false;
  if (decoder_) return true;  // which finds out
  const std::size_t planes =
      session_->buffers()[static_cast<std::size_t>(completion.buffer)].plane_count();
  if (planes == 1) return completion.bytes[0] >= layout_.bytes;
  for (std::size_t i = 0; i < planes; ++i) {
    if (completion.bytes[i] < PlaneBytes(layout_, i)) return false;
  }
  return true;
}

// The newest whole picture, or nullptr. The others go back.
const Completion* LibcameraCamera::Newest(const Completions& completions) {
  const Completion* newest = nullptr;
  for (const Completion& completion : completions) {
    const bool whole = IsWhole(completion);
    if (!whole) ++counts_.damaged;
    // A camera that does not take a buffer has gone or will fall silent; either shows soon.
    const Completion* const back = whole ? newest : &completion;
    if (back != nullptr) session_->Queue(back->buffer);
    if (whole) newest = &completion;
  }
  return newest;
}

Result<Frame> LibcameraCamera::FrameOf(const Completion& completion) {
  const MappedBuffer& buffer = session_->buffers()[static_cast<std::size_t>(completion.buffer)];
  Frame frame;
  frame.seq = count_.Next(completion.sequence);
  frame.captured = CaptureTime(completion.stamp_ns, clock_.Now());
  buffer.BeginRead();
  if (!decoder_) {
    held_ = completion.buffer;
    frame.image = *buffer.View(layout_);  // fitted at Start
    return frame;
  }
  const auto jpeg = buffer.plane(0);
  const Result<ImageView> decoded =
      decoder_->Decode(jpeg.first(std::min(completion.bytes[0], jpeg.size())));
  buffer.EndRead();
  session_->Queue(completion.buffer);
  if (!decoded) {
    ++counts_.damaged;
    return decoded.error();
  }
  frame.image = *decoded;
  return frame;
}

Result<Frame> LibcameraCamera::Acquire(std::chrono::milliseconds timeout) {
  reason_ = {};
  if (!running_) return Errc::kDisconnected;
  const Steady::time_point deadline = Steady::now() + timeout;
  const std::uint64_t damaged_before = counts_.damaged;
  for (;;) {
    const Result<Completions> completions = hand_over_.Take(deadline);
    if (!completions) {
      if (completions.error() == Errc::kDisconnected) {
        Stop();
        reason_ = gone_;
      } else if (counts_.damaged != damaged_before) {
        reason_ = damaged_;
      }
      return completions.error();
    }
    if (const Completion* const newest = Newest(*completions)) {
      if (const Result<Frame> frame = FrameOf(*newest)) return frame;
    }
    // Damaged pictures only, so far. Take ends the wait: at the deadline it gives what there is,
    // and a camera is slower than this loop.
  }
}

void LibcameraCamera::Release(const Frame& /*frame*/) {
  if (held_ < 0) return;
  session_->buffers()[static_cast<std::size_t>(held_)].EndRead();
  session_->Queue(held_);
  held_ = -1;
}

std::string LibcameraCamera::Describe() const {
  std::array<char, 32> rate{};
  std::snprintf(rate.data(), rate.size(), " at %.4g fps", negotiated_.fps);
  return (negotiated_.model.empty() ? "" : negotiated_.model + " ") + "(" + negotiated_.id +
         "): " + libcamera::Describe(negotiated_.mode) +
         (negotiated_.fps > 0 ? rate.data() : " at a rate of its own") + ", " +
         std::to_string(session_->buffers().size()) + " buffers";
}

}  // namespace facewire::hal::libcamera
