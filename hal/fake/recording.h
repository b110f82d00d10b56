#ifndef FACEWIRE_HAL_FAKE_RECORDING_H_
#define FACEWIRE_HAL_FAKE_RECORDING_H_

#include <array>
#include <cstddef>
#include <cstdint>

namespace facewire::hal::fake {

// The last N things that happened, oldest first, in place; older ones are forgotten but counted. A
// fake may run in the service for months.
template <class T, std::size_t N>
class Recording {
 public:
  void Add(const T& item) noexcept {
    items_[total_ % N] = item;
    ++total_;
  }
  void Clear() noexcept { total_ = 0; }

  static constexpr std::size_t capacity() noexcept { return N; }
  std::uint64_t total() const noexcept { return total_; }
  std::size_t size() const noexcept { return total_ < N ? static_cast<std::size_t>(total_) : N; }
  // i = 0 is the oldest that is still held; i < size().
  const T& operator[](std::size_t i) const noexcept { return items_[(total_ - size() + i) % N]; }

 private:
  std::array<T, N> items_{};
  std::uint64_t total_ = 0;
};

}  // namespace facewire::hal::fake

#endif  // FACEWIRE_HAL_FAKE_RECORDING_H_
