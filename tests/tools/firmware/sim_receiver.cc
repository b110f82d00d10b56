// sim_receiver: the receiver firmware on a simulated ATmega328P in real time, its line on a
// pseudo-terminal, a hobby servo behind each of its pulses. Options and trace are those of sim_bus
// (tests/sim/README.md).

#include <memory>

#include "tests/sim/sim_bus_options.h"
#include "tests/sim/sim_program.h"
#include "tests/tools/firmware/avr_bus.h"

int main(int count, char** arguments) {
  using facewire::firmware::AvrBus;
  const facewire::sim::OwnProgram program{
      .name = "sim_receiver",
      .description = "The receiver firmware on a pseudo-terminal, in real time, with its servos.",
      .most_servos = facewire::firmware::SimulatedBoard::kServos,
      .low = AvrBus::kLow,
      .high = AvrBus::kHigh,
      .make = [](const facewire::sim::BusOptions& options, std::size_t servos) {
        return std::make_unique<AvrBus>(options, servos);
      }};
  int exit_code = 0;
  facewire::sim::SimBusOptions options =
      facewire::sim::ParseSimBusOptions(program, count, arguments, exit_code);
  if (!options.bus) return exit_code;
  return facewire::sim::RunOnPty(program.name, options);
}
