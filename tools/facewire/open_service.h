#ifndef FACEWIRE_TOOLS_FACEWIRE_OPEN_SERVICE_H_
#define FACEWIRE_TOOLS_FACEWIRE_OPEN_SERVICE_H_

#include <memory>
#include <string>

#include "hal/serial_port.h"

namespace facewire::tools {

// An open line to a service wherever it is: its socket on this machine, or a device at the end of a
// serial line. Throws BadInput when there is none, or no permission.
std::unique_ptr<hal::SerialPort> OpenService(const std::string& where, int baud);

}  // namespace facewire::tools

#endif  // FACEWIRE_TOOLS_FACEWIRE_OPEN_SERVICE_H_
