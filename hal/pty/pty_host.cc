#include "hal/pty/pty_host.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <climits>
#include <cstdlib>
#include <string_view>

#include "hal/posix/byte_stream.h"
#include "hal/posix/errors.h"
#include "hal/posix/raw_mode.h"

namespace facewire::hal::pty {
namespace {

// The kernel tells at once that nobody has the device open, but cannot wait for somebody to open
// it: so look again this often.
constexpr int kLookForReaderMs = 5;

void Nap(const posix::Deadline& deadline) noexcept {
  ::poll(nullptr, 0, std::min(kLookForReaderMs, deadline.remaining_ms()));
}

bool LinksTo(const std::string& link, std::string_view target) noexcept {
  std::array<char, PATH_MAX> text;
  const ssize_t size = ::readlink(link.c_str(), text.data(), text.size());
  return size >= 0 && std::string_view(text.data(), static_cast<std::size_t>(size)) == target;
}

}  // namespace

Result<> PtyHost::Open() {
  if (master_) return {};
  posix::UniqueFd master(::posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
  if (!master) return posix::OpenError(errno);
  std::array<char, 64> name;
  if (::grantpt(master.get()) != 0 || ::unlockpt(master.get()) != 0 ||
      ::ptsname_r(master.get(), name.data(), name.size()) != 0) {
    return Errc::kIo;
  }
  {
    // Opened and closed once: the settings stay with the device, so that even `cat` gets raw bytes,
    // and from now on the kernel reports whether somebody has it open.
    posix::UniqueFd slave(::open(name.data(), O_RDWR | O_NOCTTY | O_CLOEXEC));
    if (!slave) return posix::OpenError(errno);
    if (Result<> raw = posix::SetRaw(slave.get()); !raw) return raw;
  }
  std::string device_path = name.data();
  if (Result<> linked = MakeLink(device_path); !linked) return linked;
  device_path_ = std::move(device_path);
  unread_ = false;
  master_ = std::move(master);
  return {};
}

Result<> PtyHost::MakeLink(const std::string& device_path) const {
  if (link_.empty()) return {};
  struct stat node {};
  if (::lstat(link_.c_str(), &node) == 0 && !S_ISLNK(node.st_mode)) return Errc::kBusy;
  // Made aside and renamed, so that the link never vanishes under somebody who is about to open it.
  const std::string aside = link_ + "." + std::to_string(::getpid());
  ::unlink(aside.c_str());
  if (::symlink(device_path.c_str(), aside.c_str()) != 0) return posix::OpenError(errno);
  if (::rename(aside.c_str(), link_.c_str()) != 0) {
    const Errc error = posix::OpenError(errno);
    ::unlink(aside.c_str());
    return error;
  }
  return {};
}

void PtyHost::Close() {
  if (!master_) return;
  // Another host may have taken the link over in the meantime.
  if (!link_.empty() && LinksTo(link_, device_path_)) ::unlink(link_.c_str());
  device_path_.clear();
  master_.Reset();
}

// From the device's own end: a flush of the master's does not reach what the kernel has already put
// into the device's line buffer.
void PtyHost::DropUnread() noexcept {
  if (!unread_) return;
  const posix::UniqueFd device(
      ::open(device_path_.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
  unread_ = !device || ::tcflush(device.get(), TCIFLUSH) != 0;
}

Result<std::size_t> PtyHost::Write(std::span<const std::byte> bytes,
                                   std::chrono::milliseconds timeout) {
  if (!master_) return Errc::kDisconnected;
  const posix::Deadline deadline(timeout);
  std::size_t taken = 0;
  while (taken < bytes.size()) {
    Result<> ready = posix::WaitFor(master_.get(), POLLOUT, deadline);
    Result<std::size_t> count = ready ? posix::TryWrite(master_.get(), bytes.subspan(taken))
                                      : Result<std::size_t>(ready.error());
    if (count) {
      taken += *count;
      unread_ = true;
      continue;
    }
    if (count.error() == Errc::kDisconnected) {
      DropUnread();
      // A message that lost its reader half-way has no second half for the next one.
      if (taken > 0) return taken;
      if (!deadline.passed()) {
        Nap(deadline);
        continue;
      }
    } else if (count.error() == Errc::kIo) {
      return Errc::kIo;
    }
    if (!deadline.passed()) continue;
    if (taken == 0) return Errc::kTimeout;
    break;
  }
  return taken;
}

Result<std::size_t> PtyHost::Read(std::span<std::byte> buffer, std::chrono::milliseconds timeout) {
  if (!master_) return Errc::kDisconnected;
  const posix::Deadline deadline(timeout);
  for (;;) {
    Result<std::size_t> count =
        posix::ReadFor(master_.get(), buffer, std::chrono::milliseconds(deadline.remaining_ms()));
    if (count || count.error() != Errc::kDisconnected) return count;
    if (deadline.passed()) return Errc::kTimeout;
    Nap(deadline);
  }
}

}  // namespace facewire::hal::pty
