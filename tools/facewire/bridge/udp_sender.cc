#include "tools/facewire/bridge/udp_sender.h"

#include <netdb.h>
#include <sys/socket.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <memory>

#include "app/error.h"

namespace facewire::tools {
namespace {

bool IsPort(const std::string& text) {
  int port = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), port);
  return error == std::errc() && end == text.data() + text.size() && port >= 1 && port <= 65535;
}

}  // namespace

Destination ParseDestination(const std::string& option, const std::string& text, int default_port) {
  Destination to{.host = text, .port = std::to_string(default_port)};
  const auto wrong = [&](const std::string& why) {
    return app::BadInput(option + " '" + text + "': " + why);
  };
  std::size_t host_end = text.find(':');
  if (text.starts_with('[')) {
    const std::size_t bracket = text.find(']');
    if (bracket == std::string::npos) throw wrong("the ']' is missing; give [ADDRESS]:PORT");
    to.host = text.substr(1, bracket - 1);
    host_end = bracket + 1 == text.size() ? std::string::npos : bracket + 1;
  } else if (host_end != std::string::npos) {
    if (text.find(':', host_end + 1) != std::string::npos) {
      throw wrong("an IPv6 address stands in brackets, [ADDRESS]:PORT");
    }
    to.host = text.substr(0, host_end);
  }
  if (to.host.empty()) throw wrong("the host is missing; give HOST:PORT");
  if (host_end == std::string::npos) return to;
  to.port = text.substr(host_end + 1);
  if (text[host_end] != ':' || !IsPort(to.port)) throw wrong("a port is a number from 1 to 65535");
  return to;
}

UdpSender::UdpSender(const std::string& option, const std::string& text, int default_port)
    : name_(text) {
  const Destination to = ParseDestination(option, text, default_port);
  addrinfo wanted{};
  wanted.ai_family = AF_UNSPEC;
  wanted.ai_socktype = SOCK_DGRAM;
  addrinfo* list = nullptr;
  const int answer = getaddrinfo(to.host.c_str(), to.port.c_str(), &wanted, &list);
  if (answer != 0) {
    throw app::BadInput(option + ": cannot find the host '" + to.host +
                        "': " + gai_strerror(answer));
  }
  const std::unique_ptr<addrinfo, void (*)(addrinfo*)> owned(list, freeaddrinfo);
  int error = 0;
  for (const addrinfo* one = list; one != nullptr; one = one->ai_next) {
    hal::posix::UniqueFd made(
        socket(one->ai_family, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, one->ai_protocol));
    // Connected, so that a place where nobody listens is noticed.
    if (made && connect(made.get(), one->ai_addr, one->ai_addrlen) == 0) {
      socket_ = std::move(made);
      return;
    }
    error = errno;
  }
  throw app::BadInput(option + ": there is no way to " + text + ": " + std::strerror(error));
}

void UdpSender::Send(std::span<const std::byte> datagram) noexcept {
  // The refusal of an earlier datagram is reported to the next one, which is then not sent: once
  // more.
  for (int tries = 0; tries < 2; ++tries) {
    if (send(socket_.get(), datagram.data(), datagram.size(), MSG_NOSIGNAL) >= 0) {
      ++sent_;
      return;
    }
    ++failed_;
    if (errno != ECONNREFUSED) return;
  }
}

}  // namespace facewire::tools
