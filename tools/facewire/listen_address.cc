#include "tools/facewire/listen_address.h"

#include <arpa/inet.h>
#include <netdb.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <memory>

#include "app/error.h"
#include "hal/posix/unique_fd.h"

namespace facewire::tools {
namespace {

sockaddr_in Resolve(const std::string& address) {
  addrinfo wanted{};
  wanted.ai_family = AF_INET;
  wanted.ai_socktype = SOCK_STREAM;
  addrinfo* list = nullptr;
  // An empty name would be every address.
  const int answer =
      address.empty() ? EAI_NONAME : getaddrinfo(address.c_str(), nullptr, &wanted, &list);
  if (answer != 0) {
    throw app::BadInput("--address '" + address +
                        "' is no IPv4 address and no name of one; 127.0.0.1 is this machine "
                        "alone, 0.0.0.0 is every network");
  }
  const std::unique_ptr<addrinfo, void (*)(addrinfo*)> owned(list, freeaddrinfo);
  sockaddr_in found{};
  std::memcpy(&found, list->ai_addr, sizeof found);
  return found;
}

}  // namespace

std::string ListenAddress(const std::string& address, int port) {
  sockaddr_in place = Resolve(address);
  std::array<char, INET_ADDRSTRLEN> text{};
  (void)inet_ntop(AF_INET, &place.sin_addr, text.data(), text.size());

  // Tried as a server does, because the library that serves waits for an address that is not there,
  // and does not say what it did not get.
  place.sin_port = htons(static_cast<in_port_t>(port));
  const hal::posix::UniqueFd probe(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
  const int on = 1;
  (void)setsockopt(probe.get(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
  if (bind(probe.get(), reinterpret_cast<const sockaddr*>(&place), sizeof place) == 0 &&
      listen(probe.get(), 1) == 0) {
    return text.data();
  }
  switch (errno) {
    case EADDRNOTAVAIL:
      throw app::BadInput("--address " + address + " is not of this machine; `ip -4 address` " +
                          "lists its own");
    case EADDRINUSE:
      throw app::Failure("port " + std::to_string(port) + " of " + address +
                         " is taken; --web-port 0 finds one that is free");
    case EACCES:
      throw app::Failure("port " + std::to_string(port) +
                         " is not for every user; --web-port 8080 is");
    default:
      throw app::Failure("cannot listen on " + address + " port " + std::to_string(port) + ": " +
                         std::strerror(errno));
  }
}

}  // namespace facewire::tools
