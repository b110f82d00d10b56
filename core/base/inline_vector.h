#ifndef FACEWIRE_CORE_BASE_INLINE_VECTOR_H_
#define FACEWIRE_CORE_BASE_INLINE_VECTOR_H_

#include <array>
#include <cstddef>
#include <span>

namespace facewire {

// A sequence of up to N values held in place. Full is an answer, not undefined behaviour.
template <class T, std::size_t N>
class InlineVector {
 public:
  static constexpr std::size_t capacity() noexcept { return N; }
  constexpr std::size_t size() const noexcept { return size_; }
  constexpr bool empty() const noexcept { return size_ == 0; }
  constexpr bool full() const noexcept { return size_ == N; }

  // False, with nothing changed, when full.
  [[nodiscard]] constexpr bool try_push(const T& value) noexcept {
    if (full()) return false;
    items_[size_++] = value;
    return true;
  }
  // False, with nothing changed, when count > N. New items are value-initialised.
  [[nodiscard]] constexpr bool try_resize(std::size_t count) noexcept {
    if (count > N) return false;
    for (std::size_t i = size_; i < count; ++i) items_[i] = T{};
    size_ = count;
    return true;
  }
  constexpr void clear() noexcept { size_ = 0; }

  constexpr T& operator[](std::size_t i) noexcept { return items_[i]; }
  constexpr const T& operator[](std::size_t i) const noexcept { return items_[i]; }
  constexpr T* begin() noexcept { return items_.data(); }
  constexpr T* end() noexcept { return items_.data() + size_; }
  constexpr const T* begin() const noexcept { return items_.data(); }
  constexpr const T* end() const noexcept { return items_.data() + size_; }
  constexpr std::span<T> span() noexcept { return {items_.data(), size_}; }
  constexpr std::span<const T> span() const noexcept { return {items_.data(), size_}; }

 private:
  std::array<T, N> items_{};
  std::size_t size_ = 0;
};

}  // namespace facewire

#endif  // FACEWIRE_CORE_BASE_INLINE_VECTOR_H_
