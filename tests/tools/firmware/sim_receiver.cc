// sim_receiver: the receiver firmware on a simulated ATmega328P in real time, its line on a
// pseudo-terminal, a hobby servo behind each of its pulses. Options and trace are those of sim_bus
// (tests/sim/README.md).

#include <cstdio>
#include <memory>

#include "hal/system_clock.h"
#include "tests/sim/sim_bus_options.h"
#include "tests/sim/sim_program.h"
#include "tests/tools/firmware/avr_bus.h"

int main(int count, char** arguments) {
  using facewire::firmware::AvrBus;
  facewire::hal::SystemClock clock;
  const AvrBus* board = nullptr;
  const facewire::sim::OwnProgram program{
      .name = "sim_receiver",
      .description = "The receiver firmware on a pseudo-terminal, in real time, with its servos.",
      .most_servos = facewire::firmware::SimulatedBoard::kServos,
      .low = AvrBus::kLow,
      .high = AvrBus::kHigh,
      .make = [&](const facewire::sim::BusOptions& options, std::size_t servos) {
        auto bus = std::make_unique<AvrBus>(options, servos, &clock);
        board = bus.get();
        return bus;
      }};
  int exit_code = 0;
  facewire::sim::SimBusOptions options =
      facewire::sim::ParseSimBusOptions(program, count, arguments, exit_code);
  if (!options.bus) return exit_code;
  exit_code = facewire::sim::RunOnPty(program.name, options);
  const auto still_ms = board->stood_still() / std::chrono::milliseconds(1);
  if (still_ms > 0) {
    std::printf("this computer is too slow: the processor stood still for %lld ms\n",
                static_cast<long long>(still_ms));
  }
  return exit_code;
}
