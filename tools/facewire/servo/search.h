#ifndef FACEWIRE_TOOLS_FACEWIRE_SERVO_SEARCH_H_
#define FACEWIRE_TOOLS_FACEWIRE_SERVO_SEARCH_H_

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "hal/clock.h"
#include "hal/serial_port.h"
#include "tools/facewire/servo/found_bus.h"

namespace facewire::tools {

struct SearchPlan {
  // In this order: what a protocol asks must not mean a motion to those before it. A Dynamixel's
  // ping has bytes that a Maestro takes for a target, or for an error that sends it to its homes.
  std::vector<Protocol> protocols = {Protocol::kReceiver, Protocol::kMaestro, Protocol::kDynamixel,
                                     Protocol::kFeetech};
  std::vector<int> rates;  // empty: the usual ones of each protocol
  bool all_ids = false;    // of Feetech servos, not only 0 to 20
};

// Makes the port with a rate; not open.
using PortMaker = std::function<std::unique_ptr<hal::SerialPort>(int baud)>;

struct PortSearch {
  std::vector<FoundBus> buses;     // servos of one chain with different rates are several
  std::vector<std::string> tried;  // without success: "Dynamixel at 57600, 1000000 baud"
};

// Tries every protocol of the plan at every rate. A line speaks one protocol: after the first that
// answers only the other rates of a chain are tried. `progress` is told each step. Throws as
// app::OpenSerialPort, except for a rate that the port cannot do: that one is left out.
PortSearch SearchPort(const std::string& path, const PortMaker& make, hal::Clock& clock,
                      const SearchPlan& plan,
                      const std::function<void(const std::string&)>& progress);

// Every serial port of this machine that a servo bus can hang on, by path.
std::vector<std::string> SerialPorts();

}  // namespace facewire::tools

#endif  // FACEWIRE_TOOLS_FACEWIRE_SERVO_SEARCH_H_
