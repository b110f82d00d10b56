#ifndef FACEWIRE_CORE_TRACK_NETWORK_MEMORY_H_
#define FACEWIRE_CORE_TRACK_NETWORK_MEMORY_H_

#include <cstddef>
#include <span>

#include "core/base/result.h"

namespace facewire::track {

// The one block in which a tracker's networks live, and XNNPACK's allocator on it. What stays grows
// from the front; what is needed only while a network is built (expanded weights, the graph before
// it is compiled) grows from the back, and the next network uses that room again. Nothing is given
// back one by one.
class NetworkMemory {
 public:
  NetworkMemory() noexcept = default;
  explicit NetworkMemory(std::span<std::byte> block) noexcept
      : begin_(block.data()),
        front_(block.data()),
        back_(block.data() + block.size()),
        end_(back_) {}

  // Uninitialised memory at a multiple of `alignment` (a power of two), with XNN_EXTRA_BYTES of
  // readable padding behind it; nullptr when the block is used up.
  void* AllocatePermanent(std::size_t size, std::size_t alignment) noexcept;
  void* AllocateTemporary(std::size_t size, std::size_t alignment) noexcept;
  // Forgets everything temporary.
  void ReleaseTemporary() noexcept { back_ = end_; }

  // While one of these lives, XNNPACK called from this thread allocates here. Without one, every
  // allocation of XNNPACK fails: that is how "no allocation after start" is kept.
  class Scope {
   public:
    enum class Kind { kPermanent, kTemporary };
    Scope(NetworkMemory& memory, Kind kind) noexcept;
    ~Scope();
    Scope(const Scope&) = delete;
    Scope& operator=(const Scope&) = delete;
    void* Allocate(std::size_t size, std::size_t alignment) noexcept;

   private:
    NetworkMemory& memory_;
    Kind kind_;
    Scope* outer_;
  };

  // Starts XNNPACK (once a process) with the allocator above. kUnsupported on a processor that it
  // does not know.
  static Result<> StartXnnpack() noexcept;

 private:
  std::byte* begin_ = nullptr;
  std::byte* front_ = nullptr;  // end of what stays
  std::byte* back_ = nullptr;   // start of what is temporary
  std::byte* end_ = nullptr;
};

}  // namespace facewire::track

#endif  // FACEWIRE_CORE_TRACK_NETWORK_MEMORY_H_
