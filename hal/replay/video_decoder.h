#ifndef FACEWIRE_HAL_REPLAY_VIDEO_DECODER_H_
#define FACEWIRE_HAL_REPLAY_VIDEO_DECODER_H_

#include <cstdint>
#include <memory>
#include <string>

#include "core/base/result.h"
#include "core/frame.h"

namespace facewire::hal::replay {

// A video file as a sequence of pictures, from its beginning, once. What decodes one is a module
// of its own (README.md), so no decoder's type may show here. Throws nothing. Not thread-safe.
class VideoDecoder {
 public:
  virtual ~VideoDecoder() = default;

  // Decodes the first picture. kUnsupported: not a video, or nothing in it can be decoded.
  virtual Result<> Open(const std::string& path) = 0;
  // Goes on to the next picture; false at the end, and where the size of the picture changes.
  // `wanted` false passes over it without the work of converting it.
  virtual bool Advance(bool wanted) = 0;
  // The picture that was decoded last, kBgr24, upright; valid until the next call.
  virtual ImageView Picture() const = 0;
  // Pictures a second, and pictures in all, as the file claims: 0, or nonsense, when it does not.
  virtual double ClaimedFps() const = 0;
  virtual double ClaimedFrames() const = 0;
};

// What the module exports, under kMakeVideoDecoder: the caller owns the decoder.
using MakeVideoDecoder = VideoDecoder*();
inline constexpr const char* kMakeVideoDecoder = "FacewireMakeVideoDecoder";

// The module is loaded with the first call, and stays. Null when it cannot be loaded; then
// `problem` says, in one line, what is missing and what installs it.
std::unique_ptr<VideoDecoder> LoadVideoDecoder(std::string& problem);

}  // namespace facewire::hal::replay

#endif  // FACEWIRE_HAL_REPLAY_VIDEO_DECODER_H_
