#include "hal/local/local_listener.h"

#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <utility>

#include "hal/local/local_port.h"
#include "hal/local/local_socket.h"
#include "hal/posix/errors.h"

namespace facewire::hal::local {
namespace {

constexpr mode_t kMode = 0660;
constexpr int kWaiting = 4;  // clients that have connected and were not accepted yet

// Makes room at `path`: removes a socket behind which nobody is.
Result<> RemoveStale(const std::string& path) {
  const Result<bool> socket = IsSocket(path);
  if (!socket) return socket.error();
  if (!*socket) return Errc::kUnsupported;
  LocalPort probe(path);
  const Result<> answered = probe.Open();
  // A queue that is full has somebody behind it, too.
  if (answered || answered.error() == Errc::kBusy) return Errc::kBusy;
  if (answered.error() != Errc::kNotFound) return answered;
  if (::unlink(path.c_str()) != 0 && errno != ENOENT) return posix::OpenError(errno);
  return {};
}

}  // namespace

Result<> LocalListener::Open(const std::string& path) {
  if (fd_) return {};
  Result<posix::UniqueFd> fd = MakeSocket();
  if (!fd) return fd.error();
  // Before the file exists: it must not be open to everybody even for a moment.
  if (::fchmod(fd->get(), kMode) != 0) return Errc::kIo;
  Result<> bound = Bind(fd->get(), path);
  if (!bound && bound.error() == Errc::kBusy) {
    if (const Result<> room = RemoveStale(path); !room) return room;
    bound = Bind(fd->get(), path);
  }
  if (!bound) return bound;
  struct stat node {};
  // The process's mask has taken the group's right to write, which is the right to connect.
  if (::chmod(path.c_str(), kMode) != 0 || ::stat(path.c_str(), &node) != 0 ||
      ::listen(fd->get(), kWaiting) != 0) {
    ::unlink(path.c_str());
    return Errc::kIo;
  }
  path_ = path;
  device_ = node.st_dev;
  inode_ = node.st_ino;
  fd_ = std::move(*fd);
  return {};
}

Result<posix::UniqueFd> LocalListener::Accept() noexcept {
  if (!fd_) return Errc::kDisconnected;
  posix::UniqueFd client(::accept4(fd_.get(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC));
  if (client) return client;
  // A client that has gone again, or a signal: the next tick looks again.
  if (errno == EAGAIN || errno == EWOULDBLOCK || errno == ECONNABORTED || errno == EINTR) {
    return Errc::kNotReady;
  }
  return Errc::kIo;
}

void LocalListener::Close() noexcept {
  if (!fd_) return;
  struct stat node {};
  if (::stat(path_.c_str(), &node) == 0 && node.st_dev == device_ && node.st_ino == inode_) {
    ::unlink(path_.c_str());
  }
  fd_.Reset();
}

}  // namespace facewire::hal::local
