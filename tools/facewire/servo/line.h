#ifndef FACEWIRE_TOOLS_FACEWIRE_SERVO_LINE_H_
#define FACEWIRE_TOOLS_FACEWIRE_SERVO_LINE_H_

#include <cstddef>
#include <functional>
#include <span>

#include "hal/clock.h"
#include "hal/serial_port.h"

namespace facewire::tools {

// Questions and answers on an open port. All time comes from `clock` and the port's own waits, so
// with a simulated bus and its clock a search takes no time.
class Line {
 public:
  // Both are borrowed.
  Line(hal::SerialPort& port, hal::Clock& clock) noexcept : port_(port), clock_(clock) {}

  // Throws Failure when the port is gone or takes nothing.
  void Send(std::span<const std::byte> bytes);
  // Passes on what comes until `take` says that it has all, or `timeout` is over. Whether it has.
  // Throws Failure when the port is gone.
  bool Receive(Duration timeout, const std::function<bool(std::span<const std::byte>)>& take);
  // Throws away what comes until nothing has come for so long.
  void Drain(Duration quiet);

 private:
  hal::SerialPort& port_;
  hal::Clock& clock_;
};

}  // namespace facewire::tools

#endif  // FACEWIRE_TOOLS_FACEWIRE_SERVO_LINE_H_
