#ifndef FACEWIRE_HAL_JPEG_JPEG_DECODER_H_
#define FACEWIRE_HAL_JPEG_JPEG_DECODER_H_

#include <cstdint>
#include <memory>
#include <span>

#include "core/base/result.h"
#include "core/frame.h"

namespace facewire::hal::jpeg {

// Decodes the pictures of a camera that compresses each by itself (Motion JPEG), all of one size,
// into memory taken when it is made. Not thread-safe.
class JpegDecoder {
 public:
  // Pictures of up to kMaxSidePx a side. Throws std::bad_alloc.
  static constexpr int kMaxSidePx = 16384;
  JpegDecoder(int width_px, int height_px);
  ~JpegDecoder();
  JpegDecoder(const JpegDecoder&) = delete;
  JpegDecoder& operator=(const JpegDecoder&) = delete;

  // The picture as kRgb24 with packed rows, in the decoder's memory until the next call. Nothing of
  // one picture stays for the next one. Allocates nothing.
  // kCorrupt: not a whole JPEG, of another size, or damaged as far as JPEG lets one see: it has no
  // checksum, and a wrong bit may be just another picture.
  Result<ImageView> Decode(std::span<const std::uint8_t> jpeg) noexcept;

 private:
  class Library;  // libjpeg's types stay in the source file
  std::unique_ptr<Library> library_;
};

}  // namespace facewire::hal::jpeg

#endif  // FACEWIRE_HAL_JPEG_JPEG_DECODER_H_
