#ifndef FACEWIRE_HAL_LIBCAMERA_MAPPED_BUFFER_H_
#define FACEWIRE_HAL_LIBCAMERA_MAPPED_BUFFER_H_

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/base/inline_vector.h"
#include "core/base/result.h"
#include "hal/pixel_layout.h"

namespace facewire::hal::libcamera {

// A plane of a picture inside a file: the memory of a driver (a dma-buf).
struct PlaneExtent {
  int fd = -1;
  std::size_t offset = 0;
  std::size_t length = 0;
};

// The memory of one picture, readable for as long as this object lives, which the files' owner
// outlives. Planes that share a file share a mapping.
class MappedBuffer {
 public:
  // kIo: the memory cannot be mapped; kUnsupported: no plane, or more than three.
  static Result<MappedBuffer> Map(std::span<const PlaneExtent> planes);
  MappedBuffer() = default;
  MappedBuffer(MappedBuffer&& other) noexcept;
  MappedBuffer& operator=(MappedBuffer&& other) noexcept;
  MappedBuffer(const MappedBuffer&) = delete;
  MappedBuffer& operator=(const MappedBuffer&) = delete;
  ~MappedBuffer();

  // Around every reading: the caches of an ARM board do not see by themselves what a camera has
  // written.
  void BeginRead() const noexcept { Sync(true); }
  void EndRead() const noexcept { Sync(false); }

  std::size_t plane_count() const noexcept { return planes_.size(); }
  std::span<const std::uint8_t> plane(std::size_t i) const noexcept { return planes_[i]; }

  // The picture that lies in the planes: in one plane for all of `layout`, or in one for each of
  // its own. kUnsupported: they do not hold it.
  Result<ImageView> View(const PixelLayout& layout) const noexcept;

 private:
  struct Mapping {
    int fd = -1;
    std::uint8_t* at = nullptr;
    std::size_t bytes = 0;
  };
  void Sync(bool begin) const noexcept;

  InlineVector<Mapping, 3> mappings_;
  InlineVector<std::span<const std::uint8_t>, 3> planes_;
};

// How many bytes of each plane of `layout` a whole picture fills.
std::size_t PlaneBytes(const PixelLayout& layout, std::size_t plane) noexcept;
std::size_t PlaneCount(const PixelLayout& layout) noexcept;

}  // namespace facewire::hal::libcamera

#endif  // FACEWIRE_HAL_LIBCAMERA_MAPPED_BUFFER_H_
