#include "hal/libcamera/mapped_buffer.h"

#include <linux/dma-buf.h>
#include <sys/ioctl.h>
#include <sys/mman.h>

#include <algorithm>
#include <cerrno>
#include <utility>

namespace facewire::hal::libcamera {

Result<MappedBuffer> MappedBuffer::Map(std::span<const PlaneExtent> planes) {
  MappedBuffer buffer;
  if (planes.empty() || planes.size() > decltype(planes_)::capacity()) return Errc::kUnsupported;
  for (const PlaneExtent& plane : planes) {
    const auto same = [&](const Mapping& mapping) { return mapping.fd == plane.fd; };
    if (std::any_of(buffer.mappings_.begin(), buffer.mappings_.end(), same)) continue;
    std::size_t bytes = 0;
    for (const PlaneExtent& other : planes) {
      if (other.fd == plane.fd) bytes = std::max(bytes, other.offset + other.length);
    }
    void* const at = ::mmap(nullptr, bytes, PROT_READ, MAP_SHARED, plane.fd, 0);
    if (at == MAP_FAILED) return Errc::kIo;
    static_cast<void>(buffer.mappings_.try_push({plane.fd, static_cast<std::uint8_t*>(at), bytes}));
  }
  for (const PlaneExtent& plane : planes) {
    const auto* const mapping =
        std::find_if(buffer.mappings_.begin(), buffer.mappings_.end(),
                     [&](const Mapping& candidate) { return candidate.fd == plane.fd; });
    static_cast<void>(buffer.planes_.try_push({mapping->at + plane.offset, plane.length}));
  }
  return buffer;
}

MappedBuffer::MappedBuffer(MappedBuffer&& other) noexcept { *this = std::move(other); }

MappedBuffer& MappedBuffer::operator=(MappedBuffer&& other) noexcept {
  std::swap(mappings_, other.mappings_);
  std::swap(planes_, other.planes_);
  return *this;
}

MappedBuffer::~MappedBuffer() {
  for (const Mapping& mapping : mappings_) ::munmap(mapping.at, mapping.bytes);
}

void MappedBuffer::Sync(bool begin) const noexcept {
  for (const Mapping& mapping : mappings_) {
    dma_buf_sync sync{};
    sync.flags = DMA_BUF_SYNC_READ | (begin ? DMA_BUF_SYNC_START : DMA_BUF_SYNC_END);
    // Refused by memory that is no dma-buf, which needs none of it.
    while (::ioctl(mapping.fd, DMA_BUF_IOCTL_SYNC, &sync) != 0 && errno == EINTR) {
    }
  }
}

std::size_t PlaneCount(const PixelLayout& layout) noexcept {
  return static_cast<std::size_t>(
      std::count_if(layout.view.planes.begin(), layout.view.planes.end(),
                    [](const Plane& plane) { return plane.stride_bytes > 0; }));
}

std::size_t PlaneBytes(const PixelLayout& layout, std::size_t plane) noexcept {
  const bool last = plane + 1 == PlaneCount(layout);
  return (last ? layout.bytes : layout.plane_offsets[plane + 1]) - layout.plane_offsets[plane];
}

Result<ImageView> MappedBuffer::View(const PixelLayout& layout) const noexcept {
  const std::size_t count = PlaneCount(layout);
  if (planes_.size() == 1) {
    if (planes_[0].size() < layout.bytes) return Errc::kUnsupported;
    return layout.At(planes_[0].data());
  }
  if (planes_.size() != count) return Errc::kUnsupported;
  ImageView view = layout.view;
  for (std::size_t i = 0; i < count; ++i) {
    if (planes_[i].size() < PlaneBytes(layout, i)) return Errc::kUnsupported;
    view.planes[i].data = planes_[i].data();
  }
  return view;
}

}  // namespace facewire::hal::libcamera
