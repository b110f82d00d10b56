#include "hal/posix/raw_mode.h"

#include <termios.h>

#include <cerrno>

namespace facewire::hal::posix {

Result<> SetRaw(int fd) noexcept {
  termios settings{};
  if (::tcgetattr(fd, &settings) != 0) return errno == ENOTTY ? Errc::kUnsupported : Errc::kIo;
  ::cfmakeraw(&settings);
  settings.c_cc[VMIN] = 1;  // with 0 an empty line reads like one that was hung up
  settings.c_cc[VTIME] = 0;
  while (::tcsetattr(fd, TCSANOW, &settings) != 0) {
    if (errno != EINTR) return Errc::kIo;
  }
  return {};
}

}  // namespace facewire::hal::posix
