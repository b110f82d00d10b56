#ifndef FACEWIRE_TESTS_SIM_SIM_BUS_OPTIONS_H_
#define FACEWIRE_TESTS_SIM_SIM_BUS_OPTIONS_H_

#include <cstddef>
#include <functional>
#include <memory>
#include <string>

#include "core/base/time.h"
#include "tests/sim/bus.h"

namespace facewire::sim {

// What `sim_bus` was asked to do.
struct SimBusOptions {
  std::string link;          // where the line's pseudo-terminal is linked to
  std::string trace;         // a CSV file; empty: none
  bool strict_baud = false;  // the line has the rate that a host has set; else its own, always
  Duration runs{};           // zero: until a signal
  std::string about;         // what is simulated, in one line
  std::unique_ptr<Bus> bus;
};

// Reads the command line. Where that is all (help, or an error of one line) the result has no bus
// and `exit_code` is set: 0 or 2.
SimBusOptions ParseSimBusOptions(int count, const char* const* arguments, int& exit_code);

// A kind of bus that has a program of its own, with the options that all kinds share.
struct OwnProgram {
  const char* name = "";         // of the program
  const char* description = "";  // one line for --help
  std::size_t most_servos = 0;   // and how many it has unless told otherwise
  double low = 0, high = 0;      // a servo's positions, in its own unit
  // `options` holds everything but what the bus has of its own (its rate, too).
  std::function<std::unique_ptr<Bus>(const BusOptions& options, std::size_t servos)> make{};
};
SimBusOptions ParseSimBusOptions(const OwnProgram& program, int count, const char* const* arguments,
                                 int& exit_code);

}  // namespace facewire::sim

#endif  // FACEWIRE_TESTS_SIM_SIM_BUS_OPTIONS_H_
