#ifndef FACEWIRE_HAL_LIBCAMERA_HAND_OVER_H_
#define FACEWIRE_HAL_LIBCAMERA_HAND_OVER_H_

#include <array>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <mutex>

#include "core/base/inline_vector.h"
#include "core/base/result.h"

namespace facewire::hal::libcamera {

// A camera has at most so many buffers, and so many pictures can be on their way at once.
constexpr std::size_t kMaxBuffers = 16;

// What libcamera says of a picture that has come.
struct Completion {
  int buffer = 0;      // which of the session's
  bool whole = false;  // false: the driver calls it damaged
  std::uint32_t sequence = 0;
  std::uint64_t stamp_ns = 0;
  std::array<std::size_t, 3> bytes{};  // in each plane of the buffer
};
using Completions = InlineVector<Completion, kMaxBuffers>;

// From libcamera's thread to the camera's: what has been completed since somebody last looked.
// Allocates nothing.
class HandOver {
 public:
  void Reset() noexcept;

  // From libcamera's thread.
  void Push(const Completion& completion) noexcept;
  void Lose() noexcept;  // the camera has been pulled out

  // Oldest first, at least one. Waits until `deadline` at most. kTimeout; kDisconnected once
  // lost, whatever has come before.
  Result<Completions> Take(std::chrono::steady_clock::time_point deadline);

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  Completions completed_;
  bool lost_ = false;
};

}  // namespace facewire::hal::libcamera

#endif  // FACEWIRE_HAL_LIBCAMERA_HAND_OVER_H_
