#ifndef FACEWIRE_TESTS_SIM_SIM_BUS_OPTIONS_H_
#define FACEWIRE_TESTS_SIM_SIM_BUS_OPTIONS_H_

#include <memory>
#include <string>

#include "core/base/time.h"
#include "tests/sim/bus.h"

namespace facewire::sim {

// What `sim_bus` was asked to do.
struct SimBusOptions {
  std::string link;        // where the line's pseudo-terminal is linked to
  std::string trace;       // a CSV file; empty: none
  double strict_baud = 0;  // the rate that a host must have set; 0: any will do
  Duration runs{};         // zero: until a signal
  std::string about;       // what is simulated, in one line
  std::unique_ptr<Bus> bus;
};

// Reads the command line. Where that is all (help, or an error of one line) the result has no bus
// and `exit_code` is set: 0 or 2.
SimBusOptions ParseSimBusOptions(int count, const char* const* arguments, int& exit_code);

}  // namespace facewire::sim

#endif  // FACEWIRE_TESTS_SIM_SIM_BUS_OPTIONS_H_
