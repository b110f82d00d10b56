#include "hal/replay/replay_camera.h"

#include <fcntl.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <utility>

#include "hal/posix/errors.h"
#include "hal/posix/unique_fd.h"
#include "hal/replay/video_decoder.h"

namespace facewire::hal::replay {
namespace {

constexpr double kAssumedFps = 30;
constexpr double kHighestFps = 1000;  // what a file without a rate claims is often its time base

// FFmpeg says only "no" to whatever it cannot open.
Result<> CheckReadable(const std::string& path) {
  posix::UniqueFd fd(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  if (!fd) return posix::OpenError(errno);
  struct stat file {};
  if (::fstat(fd.get(), &file) != 0) return Errc::kIo;
  if (!S_ISREG(file.st_mode)) return Errc::kUnsupported;
  return {};
}

}  // namespace

ReplayCamera::ReplayCamera(ReplayConfig config, Clock& clock)
    : config_(std::move(config)), clock_(clock) {}

ReplayCamera::~ReplayCamera() = default;

Result<> ReplayCamera::Start() {
  if (pacer_) return {};
  info_ = {};
  reason_.clear();
  const bool held = config_.memory_bytes > 0;
  Result<> ready;
  if (config_.loop == LoopMode::kPingPong && !held) ready = Errc::kInvalidArgument;
  if (ready) ready = StartDecoding();
  if (ready && held) ready = DecodeAhead();
  if (!ready) {
    Stop();
    if (reason_.empty()) reason_ = Reason(ready.error());
    return ready;
  }
  next_ = 0;
  ended_ = false;
  pacer_.emplace(clock_, config_.pace,
                 info_.fps);  // decoding ahead takes none of the recording's time
  return {};
}

std::string ReplayCamera::Reason(Errc error) const {
  switch (error) {
    case Errc::kNotFound:
      return "there is no video " + config_.path;
    case Errc::kPermission:
      return "no permission to read the video " + config_.path;
    case Errc::kUnsupported:
      return config_.path +
             " is not a video that can be played; give an mp4, mov, mkv, webm or avi file";
    case Errc::kFull:
      return config_.path + ": one frame takes " + std::to_string(info_.frame_bytes) +
             " bytes, more than the memory it may use; raise the memory, or 0 streams from the "
             "file";
    case Errc::kInvalidArgument:
      return config_.path + ": playing back and forth needs memory to decode ahead into";
    default:
      return {};
  }
}

Result<> ReplayCamera::StartDecoding() {
  if (Result<> readable = CheckReadable(config_.path); !readable) return readable;
  decoder_ = LoadVideoDecoder(reason_);
  if (decoder_ == nullptr) return Errc::kNotFound;
  if (Result<> open = decoder_->Open(config_.path); !open) return open;
  const ImageView first = decoder_->Picture();
  info_.width_px = first.width_px;
  info_.height_px = first.height_px;
  info_.frame_bytes =
      3 * static_cast<std::size_t>(info_.width_px) * static_cast<std::size_t>(info_.height_px);
  info_.fps = decoder_->ClaimedFps();
  info_.fps_assumed = !(info_.fps > 0 && info_.fps <= kHighestFps);
  if (info_.fps_assumed) info_.fps = kAssumedFps;
  const double claim = decoder_->ClaimedFrames();
  info_.frames_in_file = claim >= 1 && claim < 1e12 ? static_cast<std::uint64_t>(claim) : 0;
  return {};
}

Result<> ReplayCamera::DecodeAhead() {
  std::size_t room = config_.memory_bytes / info_.frame_bytes;
  if (room == 0) return Errc::kFull;
  if (info_.frames_in_file > 0) room = std::min<std::size_t>(room, info_.frames_in_file);
  info_.block_bytes = room * info_.frame_bytes;
  block_ = std::make_unique_for_overwrite<std::uint8_t[]>(info_.block_bytes);
  const std::size_t row_bytes = 3 * static_cast<std::size_t>(info_.width_px);
  std::uint8_t* to = block_.get();
  do {
    const Plane pixels = decoder_->Picture().planes[0];
    const std::uint8_t* from = pixels.data;
    for (int row = 0; row < info_.height_px; ++row, from += pixels.stride_bytes, to += row_bytes) {
      std::memcpy(to, from, row_bytes);
    }
    ++info_.frames_held;
  } while (info_.frames_held < room && decoder_->Advance(true));
  decoder_.reset();  // and its threads
  return {};
}

// The pixels of the n-th frame of a streamed recording, n at or after the one decoded last. kEnd,
// kIo.
Result<Plane> ReplayCamera::DecodeUpTo(std::uint64_t n) {
  while (next_ <= n) {
    // Frame 0 of a round was decoded when the file was opened.
    const bool first = next_ == 0;
    if (!first && !decoder_->Advance(next_ == n)) {
      if (config_.loop == LoopMode::kNone) return Errc::kEnd;
      const ReplayInfo before = info_;
      if (Result<> again = StartDecoding(); !again) return Errc::kIo;
      if (info_.frame_bytes != before.frame_bytes || info_.width_px != before.width_px) {
        return Errc::kIo;  // another file has taken its place
      }
    }
    ++next_;
  }
  return decoder_->Picture().planes[0];
}

Result<Frame> ReplayCamera::Acquire(std::chrono::milliseconds timeout) {
  if (!pacer_) return Errc::kDisconnected;
  if (ended_) return Errc::kEnd;
  const bool finite = block_ != nullptr && config_.loop == LoopMode::kNone;
  if (finite && next_ >= info_.frames_held) return Errc::kEnd;
  const Result<std::uint64_t> n = pacer_->Wait(next_, timeout);
  if (!n) return n.error();

  Plane pixels{.data = nullptr, .stride_bytes = 3 * info_.width_px};
  if (block_ != nullptr) {
    next_ = *n + 1;
    if (finite && *n >= info_.frames_held) return Errc::kEnd;
    pixels.data = block_.get() + LoopIndex(config_.loop, *n, info_.frames_held) * info_.frame_bytes;
  } else {
    const Result<Plane> decoded = DecodeUpTo(*n);
    if (!decoded) {
      ended_ = decoded.error() == Errc::kEnd;
      return decoded.error();
    }
    pixels = *decoded;
  }
  Frame frame{.seq = *n, .captured = pacer_->CapturedAt(*n), .image = {}};
  frame.image.format = PixelFormat::kBgr24;
  frame.image.width_px = info_.width_px;
  frame.image.height_px = info_.height_px;
  frame.image.planes[0] = pixels;
  return frame;
}

void ReplayCamera::Stop() {
  pacer_.reset();
  decoder_.reset();
  block_.reset();
}

}  // namespace facewire::hal::replay
