#ifndef FACEWIRE_TESTS_HAL_FAR_END_H_
#define FACEWIRE_TESTS_HAL_FAR_END_H_

#include <fcntl.h>
#include <poll.h>
#include <termios.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstddef>
#include <filesystem>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "hal/posix/unique_fd.h"

namespace facewire::hal::test {

// A test's own end of a line, by the plainest calls of the system, so that a fault of the code
// under test cannot hide in both ends. Exceptions fail the test.

// Writes all of `bytes` to `fd`, blocking or not.
inline void SendAll(int fd, std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t count = ::write(fd, bytes.data(), bytes.size());
    if (count > 0) {
      bytes = bytes.subspan(static_cast<std::size_t>(count));
    } else if (count < 0 && errno == EAGAIN) {
      pollfd ready{.fd = fd, .events = POLLOUT, .revents = 0};
      if (::poll(&ready, 1, 5000) == 0) throw std::runtime_error("the line takes no bytes");
    } else if (count < 0 && errno != EINTR) {
      throw std::runtime_error("the far end cannot write");
    }
  }
}

// What arrives at `fd` until there are `count` bytes, or five seconds pass without one.
inline std::vector<std::byte> ReceiveUpTo(int fd, std::size_t count) {
  std::vector<std::byte> bytes(count);
  std::size_t have = 0;
  while (have < count) {
    pollfd ready{.fd = fd, .events = POLLIN, .revents = 0};
    const int polled = ::poll(&ready, 1, 5000);
    if (polled < 0 && errno == EINTR) continue;
    if (polled <= 0 || (ready.revents & POLLIN) == 0) break;
    const ssize_t got = ::read(fd, bytes.data() + have, count - have);
    if (got > 0) have += static_cast<std::size_t>(got);
    if (got == 0 || (got < 0 && errno != EINTR && errno != EAGAIN)) break;
  }
  bytes.resize(have);
  return bytes;
}

// A real serial device as the far end: raw, at 115200 baud, and empty, because bytes of an earlier
// test may still have been on the way.
inline posix::UniqueFd OpenRawTty(const std::string& path) {
  posix::UniqueFd fd(::open(path.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC));
  termios settings{};
  if (::tcgetattr(fd.get(), &settings) != 0) throw std::runtime_error(path + " is no serial line");
  ::cfmakeraw(&settings);
  ::cfsetspeed(&settings, B115200);
  ::tcsetattr(fd.get(), TCSANOW, &settings);
  ::tcflush(fd.get(), TCIOFLUSH);
  return fd;
}

// A folder of its own for one test, gone with it.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string path = (std::filesystem::temp_directory_path() / "facewire-test-XXXXXX").string();
    if (::mkdtemp(path.data()) == nullptr) throw std::runtime_error("no temporary folder");
    path_ = path;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  std::string File(const std::string& name) const { return (path_ / name).string(); }

 private:
  std::filesystem::path path_;
};

}  // namespace facewire::hal::test

#endif  // FACEWIRE_TESTS_HAL_FAR_END_H_
