#ifndef FACEWIRE_TESTS_SIM_SIM_PROGRAM_H_
#define FACEWIRE_TESTS_SIM_SIM_PROGRAM_H_

#include <string>

#include "tests/sim/sim_bus_options.h"

namespace facewire::sim {

// The rest of a program like sim_bus: the bus of `options` in real time on a pseudo-terminal, until
// its time is over or SIGINT or SIGTERM comes. Bus time is that of hal::SystemClock. Prints a line
// when the link is there, and at the end how often each event happened. Returns the exit code;
// `program` is its name.
int RunOnPty(const std::string& program, SimBusOptions& options);

}  // namespace facewire::sim

#endif  // FACEWIRE_TESTS_SIM_SIM_PROGRAM_H_
