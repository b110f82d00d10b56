#ifndef FACEWIRE_APP_ANIMATRONIC_LATEST_H_
#define FACEWIRE_APP_ANIMATRONIC_LATEST_H_

#include <array>
#include <atomic>
#include <cstdint>
#include <type_traits>

namespace facewire::app {

// Hands the newest value from one thread to another; older ones that nobody took are lost. Neither
// side ever waits for the other, so a thread that stands still cannot hold up one that must not.
//
// Of three values one is the writer's, one the reader's, and the third changes hands.
template <class T>
class Latest {
 public:
  static_assert(std::is_trivially_copyable_v<T>);

  // The writing thread's.
  void Put(const T& value) noexcept {
    slots_[writers_] = value;
    writers_ = between_.exchange(static_cast<std::uint8_t>(writers_ | kFresh)) & kIndex;
  }

  // The reading thread's: the newest value that was not taken yet, or null. Valid until the next
  // call.
  const T* Take() noexcept {
    if ((between_.load() & kFresh) == 0) return nullptr;
    readers_ = between_.exchange(readers_) & kIndex;
    return &slots_[readers_];
  }

 private:
  static constexpr std::uint8_t kIndex = 3;
  static constexpr std::uint8_t kFresh = 4;
  static_assert(std::atomic<std::uint8_t>::is_always_lock_free);

  std::array<T, 3> slots_{};
  std::uint8_t writers_ = 0;
  std::uint8_t readers_ = 1;
  std::atomic<std::uint8_t> between_{2};  // index, and kFresh
};

}  // namespace facewire::app

#endif  // FACEWIRE_APP_ANIMATRONIC_LATEST_H_
