#ifndef FACEWIRE_APP_REQUEST_H_
#define FACEWIRE_APP_REQUEST_H_

#include <cstdint>

#include "core/wire/message.h"

namespace facewire::app {

// Who asks: the host's line, the button, or a client of the control socket. A client's number is
// its own: one that connects again, or another in its place, has another.
using Asker = std::uint32_t;
inline constexpr Asker kHostLine = 0;
inline constexpr Asker kButton = 1;
inline constexpr Asker kFirstClient = 2;

// A command, and where its answer goes.
struct Request {
  wire::Command command;
  Asker asker = kHostLine;
};

}  // namespace facewire::app

#endif  // FACEWIRE_APP_REQUEST_H_
