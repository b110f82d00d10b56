#include "app/supervisor.h"

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <charconv>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <limits>

namespace facewire::app {
namespace {

// 0 when the variable is absent or no number.
std::int64_t NumberOf(const char* variable) noexcept {
  const char* text = std::getenv(variable);
  std::int64_t number = 0;
  if (text != nullptr) std::from_chars(text, text + std::strlen(text), number);
  return number;
}

}  // namespace

Supervisor::Supervisor() noexcept {
  const char* path = std::getenv("NOTIFY_SOCKET");
  if (path == nullptr) return;
  const std::size_t length = std::strlen(path);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (length < 2 || length >= sizeof(address.sun_path)) return;
  std::memcpy(address.sun_path, path, length);
  if (path[0] == '@') address.sun_path[0] = '\0';  // a name outside the file system
  hal::posix::UniqueFd socket(::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + length);
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-reinterpret-cast): the sockets' own interface
  if (!socket || ::connect(socket.get(), reinterpret_cast<const sockaddr*>(&address), size) != 0) {
    return;
  }
  socket_ = std::move(socket);
  const std::int64_t pid = NumberOf("WATCHDOG_PID");
  if (pid == 0 || pid == ::getpid()) watchdog_interval_ = Duration(NumberOf("WATCHDOG_USEC") / 2);
}

void Supervisor::Reloading(Time now) noexcept {
  std::array<char, 80> text;
  const int size = std::snprintf(text.data(), text.size(), "RELOADING=1\nMONOTONIC_USEC=%lld",
                                 static_cast<long long>(now.time_since_epoch().count()));
  Send({text.data(), static_cast<std::size_t>(size)});
}

void Supervisor::Status(std::string_view text) noexcept {
  std::array<char, 256> message;
  const int size =
      std::snprintf(message.data(), message.size(), "STATUS=%.*s",
                    static_cast<int>(std::min<std::size_t>(text.size(), 200)), text.data());
  Send({message.data(), static_cast<std::size_t>(size)});
}

// A supervisor that does not listen must not hold up the loop, so a full socket loses the message.
void Supervisor::Send(std::string_view message) noexcept {
  if (!socket_) return;
  (void)::send(socket_.get(), message.data(), message.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
}

}  // namespace facewire::app
