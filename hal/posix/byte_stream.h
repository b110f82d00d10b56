#ifndef FACEWIRE_HAL_POSIX_BYTE_STREAM_H_
#define FACEWIRE_HAL_POSIX_BYTE_STREAM_H_

#include <chrono>
#include <cstddef>
#include <span>

#include "core/base/result.h"

namespace facewire::hal::posix {

// Reading and writing of a non-blocking terminal, in steps that a deadline can bound. Interrupted
// calls, short writes and hang-ups are dealt with here and nowhere else. Nothing allocates.

class Deadline {
 public:
  explicit Deadline(std::chrono::milliseconds timeout) noexcept;
  bool passed() const noexcept;
  // For poll: rounded up, so that a wait never ends before the deadline; 0 when it has passed.
  int remaining_ms() const noexcept;

 private:
  std::chrono::steady_clock::time_point at_;
};

// Waits until `fd` can be read or written (`events`: POLLIN or POLLOUT). kTimeout; kDisconnected
// when the other side has hung up and there is nothing left to read; kIo.
Result<> WaitFor(int fd, short events, const Deadline& deadline) noexcept;

// One read or write without waiting. kNotReady when it would have had to wait; kDisconnected; kIo.
Result<std::size_t> TryRead(int fd, std::span<std::byte> buffer) noexcept;
Result<std::size_t> TryWrite(int fd, std::span<const std::byte> bytes) noexcept;

// As SerialPort::Read and SerialPort::Write. An empty write takes 0 bytes; an empty buffer to read
// into is kInvalidArgument.
Result<std::size_t> ReadFor(int fd, std::span<std::byte> buffer,
                            std::chrono::milliseconds timeout) noexcept;
Result<std::size_t> WriteFor(int fd, std::span<const std::byte> bytes,
                             std::chrono::milliseconds timeout) noexcept;

// As SerialPort::Unsent: what waits in the system's output queue. 0 when it does not tell.
std::size_t UnsentOf(int fd) noexcept;

}  // namespace facewire::hal::posix

#endif  // FACEWIRE_HAL_POSIX_BYTE_STREAM_H_
