#ifndef FACEWIRE_TOOLS_FACEWIRE_LISTEN_ADDRESS_H_
#define FACEWIRE_TOOLS_FACEWIRE_LISTEN_ADDRESS_H_

#include <string>

namespace facewire::tools {

// The IPv4 address of this machine that `address` names (a number or a name; 0.0.0.0: all of them),
// where a program may listen at `port` (0: any that is free). BadInput: it is not one of this
// machine. Failure: the port is taken, or below those that everybody may use.
std::string ListenAddress(const std::string& address, int port);

}  // namespace facewire::tools

#endif  // FACEWIRE_TOOLS_FACEWIRE_LISTEN_ADDRESS_H_
