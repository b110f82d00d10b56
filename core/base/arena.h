#ifndef FACEWIRE_CORE_BASE_ARENA_H_
#define FACEWIRE_CORE_BASE_ARENA_H_

#include <cstddef>
#include <cstdint>
#include <memory>
#include <new>
#include <span>
#include <type_traits>

namespace facewire {

// Hands out parts of one borrowed block of memory, in order, and never takes them back. The block
// must outlive everything placed in it.
class Arena {
 public:
  explicit Arena(std::span<std::byte> block) noexcept : block_(block) {}
  Arena(const Arena&) = delete;
  Arena& operator=(const Arena&) = delete;

  std::size_t used() const noexcept { return used_; }
  std::size_t capacity() const noexcept { return block_.size(); }

  // Memory of `size` bytes at a multiple of `alignment` (a power of two), uninitialised; nullptr,
  // with nothing changed, when the rest of the block is too small.
  [[nodiscard]] void* Allocate(std::size_t size, std::size_t alignment) noexcept {
    void* at = block_.data() + used_;
    std::size_t left = block_.size() - used_;
    if (std::align(alignment, size, at, left) == nullptr) return nullptr;
    used_ = block_.size() - left + size;
    return at;
  }

  // `count` value-initialised Ts; an empty span when the rest of the block is too small (or count
  // is 0).
  template <class T>
  [[nodiscard]] std::span<T> MakeArray(std::size_t count) noexcept {
    static_assert(std::is_trivially_destructible_v<T>, "nobody destroys what lies in an arena");
    if (count > block_.size() / sizeof(T)) return {};
    void* at = Allocate(count * sizeof(T), alignof(T));
    if (at == nullptr) return {};
    T* first = static_cast<T*>(at);
    std::uninitialized_value_construct_n(first, count);
    return {first, count};
  }

 private:
  std::span<std::byte> block_;
  std::size_t used_ = 0;
};

}  // namespace facewire

#endif  // FACEWIRE_CORE_BASE_ARENA_H_
