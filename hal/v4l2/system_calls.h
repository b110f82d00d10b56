#ifndef FACEWIRE_HAL_V4L2_SYSTEM_CALLS_H_
#define FACEWIRE_HAL_V4L2_SYSTEM_CALLS_H_

#include <cstddef>

namespace facewire::hal::v4l2 {

// The calls through which the camera speaks to the kernel, as narrow as they are: each answers and
// sets errno exactly as its namesake of POSIX does. Tests put a kernel of their own here, which
// fails as no real one does on demand.
class SystemCalls {
 public:
  virtual ~SystemCalls() = default;
  virtual int Open(const char* path, int flags) = 0;
  virtual int Close(int fd) = 0;
  virtual int Ioctl(int fd, unsigned long request, void* argument) = 0;
  virtual void* Map(std::size_t length, int fd, std::size_t offset) = 0;  // shared, read and write
  virtual int Unmap(void* at, std::size_t length) = 0;
  virtual int PollReadable(int fd, int timeout_ms, short* revents) = 0;
};

// calls.Ioctl until no signal interrupts it.
int Call(SystemCalls& calls, int fd, unsigned long request, void* argument);

// The running kernel's.
SystemCalls& LinuxCalls() noexcept;

}  // namespace facewire::hal::v4l2

#endif  // FACEWIRE_HAL_V4L2_SYSTEM_CALLS_H_
