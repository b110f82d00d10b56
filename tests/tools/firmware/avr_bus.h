#ifndef FACEWIRE_TESTS_TOOLS_FIRMWARE_AVR_BUS_H_
#define FACEWIRE_TESTS_TOOLS_FIRMWARE_AVR_BUS_H_

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/base/time.h"
#include "tests/sim/bus.h"
#include "tests/tools/firmware/firmware.h"
#include "tests/tools/firmware/simulated_board.h"

namespace facewire::firmware {

// The receiver as a simulated bus (tests/sim/bus.h), as it is flashed: the image runs on a
// simulated ATmega328P, its pulses are measured at the pins, and each moves a hobby servo.
// Positions are us of pulse width; 0 is no pulse. Its line is at 115200 baud, whatever the options
// say.
class AvrBus final : public sim::Bus {
 public:
  static constexpr double kLow = 500, kHigh = 2500;  // us

  // `servos` of the twelve outputs, from the first, have a servo.
  AvrBus(const sim::BusOptions& options, std::size_t servos);

  // What the last whole servo pulses on the line asked for, whether they were obeyed or not.
  double Goal(std::size_t index) const override { return asked_.width[index] / 4.0; }
  double Commanded(std::size_t index) const override { return outputs_[index].width_us; }
  double ToOwn(double rad) const override;
  double ToRad(double own) const override;

 private:
  struct Output {
    double width_us = 0;
    double ended_ms = 0;
  };

  void OnByte(std::uint8_t byte, sim::Nanos at) override;
  void OnMillisecond(Time at) override;
  void OnPowerUp(std::size_t) override {}  // a hobby servo remembers nothing
  void MoveServo(std::size_t index);

  SimulatedBoard board_;
  std::vector<Output> outputs_;
  FwDecoder listener_{};
  FwPulses asked_{};
};

}  // namespace facewire::firmware

#endif  // FACEWIRE_TESTS_TOOLS_FIRMWARE_AVR_BUS_H_
