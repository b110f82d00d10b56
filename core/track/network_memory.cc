#include "core/track/network_memory.h"

#include <xnnpack.h>

#include <algorithm>
#include <cstdint>
#include <cstring>

namespace facewire::track {
namespace {

// Per thread, so that two trackers may be loaded at the same time.
thread_local NetworkMemory::Scope* current = nullptr;

constexpr std::size_t kAlignment = 64;  // a cache line, and XNNPACK's own XNN_ALLOCATION_ALIGNMENT
constexpr std::size_t kHeader = 64;     // in front of each block: its size, for reallocation

void* Allocate(void*, std::size_t size) {
  if (current == nullptr || size > SIZE_MAX / 2) return nullptr;
  void* block = current->Allocate(size + kHeader, kAlignment);
  if (block == nullptr) return nullptr;
  std::memcpy(block, &size, sizeof size);
  return static_cast<std::byte*>(block) + kHeader;
}

void* Reallocate(void* context, void* old, std::size_t size) {
  if (old == nullptr) return Allocate(context, size);
  std::size_t old_size = 0;
  std::memcpy(&old_size, static_cast<std::byte*>(old) - kHeader, sizeof old_size);
  if (size <= old_size) return old;
  void* grown = Allocate(context, size);
  if (grown != nullptr) std::memcpy(grown, old, old_size);
  return grown;
}

void* AllocateAligned(void* context, std::size_t alignment, std::size_t size) {
  if (alignment > kAlignment) return nullptr;
  return Allocate(context, size);
}

void Release(void*, void*) {}

constexpr xnn_allocator kAllocator = {
    .context = nullptr,
    .allocate = Allocate,
    .reallocate = Reallocate,
    .deallocate = Release,
    .aligned_allocate = AllocateAligned,
    .aligned_deallocate = Release,
};

std::uintptr_t Address(const std::byte* at) noexcept {
  return reinterpret_cast<std::uintptr_t>(at);
}

}  // namespace

void* NetworkMemory::AllocatePermanent(std::size_t size, std::size_t alignment) noexcept {
  const std::size_t skip = (alignment - Address(front_) % alignment) % alignment;
  const auto left = static_cast<std::size_t>(back_ - front_);
  if (left < skip + XNN_EXTRA_BYTES || size > left - skip - XNN_EXTRA_BYTES) return nullptr;
  std::byte* block = front_ + skip;
  front_ = block + size + XNN_EXTRA_BYTES;
  return block;
}

void* NetworkMemory::AllocateTemporary(std::size_t size, std::size_t alignment) noexcept {
  const auto left = static_cast<std::size_t>(back_ - front_);
  if (left < alignment + XNN_EXTRA_BYTES || size > left - alignment - XNN_EXTRA_BYTES)
    return nullptr;
  std::byte* block = back_ - size - XNN_EXTRA_BYTES;
  block -= Address(block) % alignment;
  back_ = block;
  return block;
}

NetworkMemory::Scope::Scope(NetworkMemory& memory, Kind kind) noexcept
    : memory_(memory), kind_(kind), outer_(current) {
  current = this;
}

NetworkMemory::Scope::~Scope() { current = outer_; }

void* NetworkMemory::Scope::Allocate(std::size_t size, std::size_t alignment) noexcept {
  return kind_ == Kind::kPermanent ? memory_.AllocatePermanent(size, alignment)
                                   : memory_.AllocateTemporary(size, alignment);
}

Result<> NetworkMemory::StartXnnpack() noexcept {
  // XNNPACK itself makes sure that only the first call in a process counts.
  if (xnn_initialize(&kAllocator) != xnn_status_success) return Errc::kUnsupported;
  return {};
}

}  // namespace facewire::track
