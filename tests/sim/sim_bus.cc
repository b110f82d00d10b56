// sim_bus: one simulated servo bus in real time on a pseudo-terminal, for programs that want a
// serial device. Ends on SIGINT or SIGTERM.

#include "tests/sim/sim_bus_options.h"
#include "tests/sim/sim_program.h"

int main(int count, char** arguments) {
  int exit_code = 0;
  facewire::sim::SimBusOptions options =
      facewire::sim::ParseSimBusOptions(count, arguments, exit_code);
  if (!options.bus) return exit_code;
  return facewire::sim::RunOnPty("sim_bus", options);
}
