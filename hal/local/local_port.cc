#include "hal/local/local_port.h"

#include <poll.h>
#include <sys/stat.h>

#include <cerrno>

#include "hal/local/local_socket.h"
#include "hal/posix/byte_stream.h"
#include "hal/posix/errors.h"

namespace facewire::hal::local {

Result<bool> IsSocket(const std::string& path) noexcept {
  struct stat node {};
  if (::stat(path.c_str(), &node) != 0) return posix::OpenError(errno);
  return S_ISSOCK(node.st_mode);
}

Result<> LocalPort::Open() {
  if (fd_) return {};
  Result<posix::UniqueFd> fd = MakeSocket();
  if (!fd) return fd.error();
  if (const Result<> connected = Connect(fd->get(), path_); !connected) {
    // The system says of any other file, too, that the connection was refused.
    const Result<bool> socket = IsSocket(path_);
    return socket && !*socket ? Errc::kUnsupported : connected.error();
  }
  fd_ = std::move(*fd);
  return {};
}

Result<std::size_t> LocalPort::Write(std::span<const std::byte> bytes,
                                     std::chrono::milliseconds timeout) {
  if (!fd_) return Errc::kDisconnected;
  const posix::Deadline deadline(timeout);
  std::size_t taken = 0;
  while (taken < bytes.size()) {
    Result<std::size_t> count = TrySend(fd_.get(), bytes.subspan(taken));
    if (count) {
      taken += *count;
      continue;
    }
    if (count.error() == Errc::kNotReady) {
      const Result<> ready = posix::WaitFor(fd_.get(), POLLOUT, deadline);
      if (ready) continue;
      if (ready.error() == Errc::kTimeout && taken > 0) break;
      count = ready.error();
    }
    if (count.error() == Errc::kDisconnected) Close();
    return count;
  }
  return taken;
}

Result<std::size_t> LocalPort::Read(std::span<std::byte> buffer,
                                    std::chrono::milliseconds timeout) {
  if (!fd_) return Errc::kDisconnected;
  if (buffer.empty()) return Errc::kInvalidArgument;
  const posix::Deadline deadline(timeout);
  for (;;) {
    Result<std::size_t> count = TryReceive(fd_.get(), buffer);
    if (!count && count.error() == Errc::kNotReady) {
      const Result<> ready = posix::WaitFor(fd_.get(), POLLIN, deadline);
      if (ready) continue;
      count = ready.error();
    }
    if (!count && count.error() == Errc::kDisconnected) Close();
    return count;
  }
}

}  // namespace facewire::hal::local
