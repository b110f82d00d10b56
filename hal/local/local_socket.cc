#include "hal/local/local_socket.h"

#include <sys/socket.h>

#include <cerrno>
#include <cstring>

#include "hal/posix/errors.h"

namespace facewire::hal::local {
namespace {

// Calls bind or connect with the address that `path` is.
template <class Call>
Result<> WithAddress(std::string_view path, Call call) noexcept {
  sockaddr_un address{};
  if (path.empty() || path.size() > kMaxPathLength) return Errc::kInvalidArgument;
  address.sun_family = AF_UNIX;
  std::memcpy(address.sun_path, path.data(), path.size());
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-reinterpret-cast): the sockets' own interface
  while (call(reinterpret_cast<const sockaddr*>(&address), socklen_t{sizeof(address)}) != 0) {
    if (errno == EINTR) continue;
    if (errno == ECONNREFUSED) return Errc::kNotFound;
    if (errno == EADDRINUSE) return Errc::kBusy;
    if (errno == EPROTOTYPE) return Errc::kUnsupported;
    return posix::OpenError(errno);
  }
  return {};
}

Result<std::size_t> Counted(ssize_t count) noexcept {
  if (count >= 0) return static_cast<std::size_t>(count);
  if (errno == EAGAIN || errno == EWOULDBLOCK) return Errc::kNotReady;
  if (errno == ECONNRESET || errno == ENOTCONN) return Errc::kDisconnected;
  return posix::DeviceError(errno);
}

}  // namespace

Result<posix::UniqueFd> MakeSocket() noexcept {
  posix::UniqueFd fd(::socket(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  if (!fd) return Errc::kIo;
  return fd;
}

Result<> Connect(int fd, std::string_view path) noexcept {
  return WithAddress(
      path, [fd](const sockaddr* address, socklen_t size) { return ::connect(fd, address, size); });
}

Result<> Bind(int fd, std::string_view path) noexcept {
  return WithAddress(
      path, [fd](const sockaddr* address, socklen_t size) { return ::bind(fd, address, size); });
}

Result<std::size_t> TrySend(int fd, std::span<const std::byte> bytes) noexcept {
  ssize_t count = 0;
  do {
    count = ::send(fd, bytes.data(), bytes.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
  } while (count < 0 && errno == EINTR);
  return Counted(count);
}

Result<std::size_t> TryReceive(int fd, std::span<std::byte> buffer) noexcept {
  if (buffer.empty()) return Errc::kInvalidArgument;
  ssize_t count = 0;
  do {
    count = ::recv(fd, buffer.data(), buffer.size(), MSG_DONTWAIT);
  } while (count < 0 && errno == EINTR);
  if (count == 0) return Errc::kDisconnected;
  return Counted(count);
}

}  // namespace facewire::hal::local
