#ifndef FACEWIRE_TOOLS_FACEWIRE_BRIDGE_UDP_SENDER_H_
#define FACEWIRE_TOOLS_FACEWIRE_BRIDGE_UDP_SENDER_H_

#include <cstdint>
#include <span>
#include <string>

#include "hal/posix/unique_fd.h"

namespace facewire::tools {

struct Destination {
  std::string host;
  std::string port;
};

// "HOST:PORT", "HOST" for `default_port`, "[ADDRESS]:PORT" for IPv6. BadInput names `option`.
Destination ParseDestination(const std::string& option, const std::string& text, int default_port);

// Datagrams to one place. The name is looked up once, at the start.
class UdpSender {
 public:
  // BadInput, naming `option`, when nobody knows the host or there is no way to it.
  UdpSender(const std::string& option, const std::string& text, int default_port);

  // Never waits, never throws: a datagram that cannot be sent now is as lost as one on the way.
  void Send(std::span<const std::byte> datagram) noexcept;

  const std::string& name() const noexcept { return name_; }  // as the person wrote it
  std::uint64_t sent() const noexcept { return sent_; }
  std::uint64_t failed() const noexcept { return failed_; }  // refused, no way there, no room

 private:
  std::string name_;
  hal::posix::UniqueFd socket_;
  std::uint64_t sent_ = 0;
  std::uint64_t failed_ = 0;
};

}  // namespace facewire::tools

#endif  // FACEWIRE_TOOLS_FACEWIRE_BRIDGE_UDP_SENDER_H_
