#ifndef FACEWIRE_HAL_REPLAY_REPLAY_CAMERA_H_
#define FACEWIRE_HAL_REPLAY_REPLAY_CAMERA_H_

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "hal/camera.h"
#include "hal/clock.h"
#include "hal/playback.h"

namespace facewire::hal::replay {

class VideoDecoder;

struct ReplayConfig {
  std::string path;  // a video file of any kind that FFmpeg reads
  Pace pace = Pace::kRealTime;
  LoopMode loop = LoopMode::kNone;
  // 0: streamed, each frame is decoded when it is acquired (the decoder allocates and has threads).
  // Otherwise Start decodes ahead into one block of at most this size, as many frames as fit, and
  // lets the decoder go: from then on nothing allocates. kPingPong needs a block.
  std::size_t memory_bytes = 0;
};

// What Start found. Zero and empty before.
struct ReplayInfo {
  int width_px = 0;
  int height_px = 0;
  double fps = 0;
  bool fps_assumed = false;          // the file gives no rate: 30 is taken
  std::uint64_t frames_in_file = 0;  // as the file claims; 0 when it does not
  std::size_t frame_bytes = 0;
  std::size_t frames_held = 0;  // in the block; a cut file holds fewer than it claims
  std::size_t block_bytes = 0;
};

// Plays a video file. Frames are kBgr24 with rows packed, turned upright as the file asks.
// Frame::seq counts from 0 at Start and goes on through loops, and so does Frame::captured. A file
// that breaks off, or changes the size of its picture, ends there. Not thread-safe.
class ReplayCamera final : public Camera {
 public:
  // `clock` is borrowed for the camera's life.
  ReplayCamera(ReplayConfig config, Clock& clock);
  ~ReplayCamera() override;

  // kNotFound (the file, or what decodes videos: reason() says which), kPermission; kUnsupported:
  // not a video, or not a single frame of it can be decoded; kFull: memory_bytes does not hold one
  // frame (info().frame_bytes says what it takes); kInvalidArgument: kPingPong without a block;
  // kIo.
  Result<> Start() override;
  // kTimeout (real time: the next frame is not due), kEnd, kDisconnected (not started), kIo.
  Result<Frame> Acquire(std::chrono::milliseconds timeout) override;
  void Release(const Frame& /*frame*/) override {}
  void Stop() override;
  std::string_view reason() const override { return reason_; }

  const ReplayInfo& info() const noexcept { return info_; }

 private:
  Result<> StartDecoding();
  Result<> DecodeAhead();
  Result<Plane> DecodeUpTo(std::uint64_t n);
  std::string Reason(Errc error) const;

  ReplayConfig config_;
  Clock& clock_;
  ReplayInfo info_;
  std::string reason_;                     // of the last Start
  std::unique_ptr<VideoDecoder> decoder_;  // while a streamed recording plays
  std::unique_ptr<std::uint8_t[]> block_;  // while a recording in memory plays
  std::optional<Pacer> pacer_;             // while started
  std::uint64_t next_ = 0;
  bool ended_ = false;
};

}  // namespace facewire::hal::replay

#endif  // FACEWIRE_HAL_REPLAY_REPLAY_CAMERA_H_
