#ifndef FACEWIRE_APP_HOST_PROTOCOL_H_
#define FACEWIRE_APP_HOST_PROTOCOL_H_

#include <cstdint>

namespace facewire::app {

// What the line to the host speaks. Native: core/wire. OSC: packets in SLIP, core/wire/osc_host.
enum class HostProtocol : std::uint8_t { kNative, kOsc };

}  // namespace facewire::app

#endif  // FACEWIRE_APP_HOST_PROTOCOL_H_
