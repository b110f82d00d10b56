#include "hal/v4l2/system_calls.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>

namespace facewire::hal::v4l2 {
namespace {

class Linux final : public SystemCalls {
 public:
  int Open(const char* path, int flags) override { return ::open(path, flags); }
  int Close(int fd) override { return ::close(fd); }
  int Ioctl(int fd, unsigned long request, void* argument) override {
    return ::ioctl(fd, request, argument);
  }
  void* Map(std::size_t length, int fd, std::size_t offset) override {
    return ::mmap(nullptr, length, PROT_READ | PROT_WRITE, MAP_SHARED, fd,
                  static_cast<off_t>(offset));
  }
  int Unmap(void* at, std::size_t length) override { return ::munmap(at, length); }
  int PollReadable(int fd, int timeout_ms, short* revents) override {
    pollfd entry{.fd = fd, .events = POLLIN, .revents = 0};
    const int count = ::poll(&entry, 1, timeout_ms);
    *revents = entry.revents;
    return count;
  }
};

}  // namespace

int Call(SystemCalls& calls, int fd, unsigned long request, void* argument) {
  int result = 0;
  do {
    result = calls.Ioctl(fd, request, argument);
  } while (result != 0 && errno == EINTR);
  return result;
}

SystemCalls& LinuxCalls() noexcept {
  static Linux calls;
  return calls;
}

}  // namespace facewire::hal::v4l2
