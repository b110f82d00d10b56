#include "hal/pty/pty_port.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <termios.h>

#include <cerrno>

#include "hal/posix/byte_stream.h"
#include "hal/posix/errors.h"
#include "hal/posix/raw_mode.h"
#include "hal/posix/tty_lock.h"

namespace facewire::hal::pty {
namespace {

// Linux, Documentation/admin-guide/devices.txt: majors 136 to 143 are Unix98 pseudo-terminal
// slaves.
constexpr unsigned kFirstPtsMajor = 136;
constexpr unsigned kLastPtsMajor = 143;

bool IsPseudoTerminal(const struct stat& node) noexcept {
  return S_ISCHR(node.st_mode) && major(node.st_rdev) >= kFirstPtsMajor &&
         major(node.st_rdev) <= kLastPtsMajor;
}

// Nothing depends on it: a rate without a name of its own stays unnoted.
void NoteRate(int fd, int baud) noexcept {
  termios settings{};
  if (baud == 0 || ::tcgetattr(fd, &settings) != 0) return;
  // glibc takes the number as well as its B constant.
  if (::cfsetspeed(&settings, static_cast<speed_t>(baud)) == 0) {
    (void)::tcsetattr(fd, TCSANOW, &settings);
  }
}

}  // namespace

Result<bool> IsPseudoTerminal(const std::string& path) noexcept {
  struct stat node {};
  if (::stat(path.c_str(), &node) != 0) return posix::OpenError(errno);
  return IsPseudoTerminal(node);
}

Result<> PtyPort::Open() {
  if (fd_) return {};
  // Looked at before it is opened: opening some other device may already do something to it.
  Result<bool> is_pty = pty::IsPseudoTerminal(path_);
  if (!is_pty) return is_pty.error();
  if (!*is_pty) return Errc::kUnsupported;

  posix::UniqueFd fd;
  do {
    fd.Reset(::open(path_.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
  } while (!fd && errno == EINTR);
  // The kernel answers EIO while the maker has not unlocked its new terminal, or is just closing
  // it.
  if (!fd) return errno == EIO ? Errc::kNotFound : posix::OpenError(errno);
  // No TIOCEXCL: a pseudo-terminal keeps that flag for as long as its maker lives, so a service
  // that crashed could never open its own line again.
  if (Result<> locked = posix::LockTty(fd.get()); !locked) return locked;
  if (Result<> raw = posix::SetRaw(fd.get()); !raw) return raw;
  NoteRate(fd.get(), baud_);
  fd_ = std::move(fd);
  return {};
}

Result<std::size_t> PtyPort::Write(std::span<const std::byte> bytes,
                                   std::chrono::milliseconds timeout) {
  if (!fd_) return Errc::kDisconnected;
  Result<std::size_t> count = posix::WriteFor(fd_.get(), bytes, timeout);
  if (!count && count.error() == Errc::kDisconnected) Close();
  return count;
}

Result<std::size_t> PtyPort::Read(std::span<std::byte> buffer, std::chrono::milliseconds timeout) {
  if (!fd_) return Errc::kDisconnected;
  Result<std::size_t> count = posix::ReadFor(fd_.get(), buffer, timeout);
  if (!count && count.error() == Errc::kDisconnected) Close();
  return count;
}

}  // namespace facewire::hal::pty
