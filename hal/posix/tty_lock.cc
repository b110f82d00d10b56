#include "hal/posix/tty_lock.h"

#include <sys/file.h>

#include <cerrno>

namespace facewire::hal::posix {

Result<> LockTty(int fd) noexcept {
  for (;;) {
    if (::flock(fd, LOCK_EX | LOCK_NB) == 0) return {};
    if (errno == EINTR) continue;
    return errno == EWOULDBLOCK ? Errc::kBusy : Errc::kIo;
  }
}

}  // namespace facewire::hal::posix
