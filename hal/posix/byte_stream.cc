#include "hal/posix/byte_stream.h"

#include <poll.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>

#include "hal/posix/errors.h"

namespace facewire::hal::posix {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

Deadline::Deadline(milliseconds timeout) noexcept
    // A caller's "for ever" must not overflow the clock; a day is longer than any wait of this
    // program.
    : at_(steady_clock::now() +
          std::clamp<milliseconds>(timeout, milliseconds(0), std::chrono::hours(24))) {}

bool Deadline::passed() const noexcept { return steady_clock::now() >= at_; }

int Deadline::remaining_ms() const noexcept {
  const auto left = std::chrono::ceil<milliseconds>(at_ - steady_clock::now());
  return static_cast<int>(std::max<milliseconds::rep>(left.count(), 0));
}

Result<> WaitFor(int fd, short events, const Deadline& deadline) noexcept {
  for (;;) {
    pollfd entry{.fd = fd, .events = events, .revents = 0};
    const int count = ::poll(&entry, 1, deadline.remaining_ms());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return Errc::kIo;
    if (count == 0) return Errc::kTimeout;
    if ((entry.revents & POLLNVAL) != 0) return Errc::kIo;
    // What arrived before a hang-up is still to be read; what is written after it reaches nobody.
    if ((entry.revents & POLLIN & events) != 0) return {};
    if ((entry.revents & (POLLHUP | POLLERR)) != 0) return Errc::kDisconnected;
    return {};
  }
}

Result<std::size_t> TryRead(int fd, std::span<std::byte> buffer) noexcept {
  for (;;) {
    const ssize_t count = ::read(fd, buffer.data(), buffer.size());
    if (count > 0) return static_cast<std::size_t>(count);
    if (count == 0) return Errc::kDisconnected;  // how a terminal says that it was hung up
    if (errno == EINTR) continue;
    if (errno == EAGAIN || errno == EWOULDBLOCK) return Errc::kNotReady;
    return DeviceError(errno);
  }
}

Result<std::size_t> TryWrite(int fd, std::span<const std::byte> bytes) noexcept {
  for (;;) {
    const ssize_t count = ::write(fd, bytes.data(), bytes.size());
    if (count > 0) return static_cast<std::size_t>(count);
    if (count == 0) return Errc::kNotReady;
    if (errno == EINTR) continue;
    if (errno == EAGAIN || errno == EWOULDBLOCK) return Errc::kNotReady;
    return DeviceError(errno);
  }
}

Result<std::size_t> ReadFor(int fd, std::span<std::byte> buffer, milliseconds timeout) noexcept {
  if (buffer.empty()) return Errc::kInvalidArgument;
  const Deadline deadline(timeout);
  for (;;) {
    if (Result<> ready = WaitFor(fd, POLLIN, deadline); !ready) return ready.error();
    Result<std::size_t> count = TryRead(fd, buffer);
    if (count || count.error() != Errc::kNotReady) return count;
  }
}

Result<std::size_t> WriteFor(int fd, std::span<const std::byte> bytes,
                             milliseconds timeout) noexcept {
  const Deadline deadline(timeout);
  std::size_t taken = 0;
  while (taken < bytes.size()) {
    Result<std::size_t> count = TryWrite(fd, bytes.subspan(taken));
    if (count) {
      taken += *count;
      continue;
    }
    if (count.error() != Errc::kNotReady) return count;
    if (Result<> ready = WaitFor(fd, POLLOUT, deadline); !ready) {
      if (ready.error() == Errc::kTimeout && taken > 0) break;
      return ready.error();
    }
  }
  return taken;
}

std::size_t UnsentOf(int fd) noexcept {
  int count = 0;
  return ::ioctl(fd, TIOCOUTQ, &count) == 0 && count > 0 ? static_cast<std::size_t>(count) : 0;
}

}  // namespace facewire::hal::posix
