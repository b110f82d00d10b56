#ifndef FACEWIRE_HAL_LOCAL_LOCAL_SOCKET_H_
#define FACEWIRE_HAL_LOCAL_LOCAL_SOCKET_H_

#include <sys/un.h>

#include <cstddef>
#include <span>
#include <string_view>

#include "core/base/result.h"
#include "hal/posix/unique_fd.h"

namespace facewire::hal::local {

// The longest path of a socket's file (the system's limit, without the terminator).
inline constexpr std::size_t kMaxPathLength = sizeof(sockaddr_un::sun_path) - 1;

// A socket that never waits. kIo.
Result<posix::UniqueFd> MakeSocket() noexcept;

// Connects `fd` to whoever listens at `path`. kInvalidArgument (path empty or too long), kNotFound
// (no such file, or nobody listens there), kUnsupported (not a socket), kPermission, kBusy (a queue
// of clients waits already), kIo.
Result<> Connect(int fd, std::string_view path) noexcept;

// As Connect; gives `path` to the socket.
Result<> Bind(int fd, std::string_view path) noexcept;

// One send or receive without waiting, and never a signal. kNotReady when it would have had to
// wait; kDisconnected; kIo.
Result<std::size_t> TrySend(int fd, std::span<const std::byte> bytes) noexcept;
Result<std::size_t> TryReceive(int fd, std::span<std::byte> buffer) noexcept;

}  // namespace facewire::hal::local

#endif  // FACEWIRE_HAL_LOCAL_LOCAL_SOCKET_H_
