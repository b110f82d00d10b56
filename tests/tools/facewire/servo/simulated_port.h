#ifndef FACEWIRE_TESTS_TOOLS_FACEWIRE_SERVO_SIMULATED_PORT_H_
#define FACEWIRE_TESTS_TOOLS_FACEWIRE_SERVO_SIMULATED_PORT_H_

#include <algorithm>
#include <deque>
#include <utility>

#include "hal/fake/fake_clock.h"
#include "hal/serial_port.h"
#include "tests/sim/bus.h"

namespace facewire::tools {

// A serial port with a simulated bus at its other end, in virtual time. Who has set another rate
// than the bus's is not heard, and hears nothing.
class SimulatedPort final : public hal::SerialPort {
 public:
  // `bus_baud` 0: the bus takes any rate.
  SimulatedPort(sim::Bus& bus, hal::fake::FakeClock& clock, int bus_baud, int baud)
      : bus_(bus), clock_(clock), deaf_(bus_baud != 0 && bus_baud != baud) {}

  Result<> Open() override { return {}; }
  Result<std::size_t> Write(std::span<const std::byte> bytes,
                            std::chrono::milliseconds /*timeout*/) override {
    if (!deaf_) bus_.Receive(bytes, clock_.Now());
    return bytes.size();
  }
  Result<std::size_t> Read(std::span<std::byte> buffer,
                           std::chrono::milliseconds timeout) override {
    const Time end = clock_.Now() + timeout;
    while (pending_.empty() && clock_.Now() < end) {
      clock_.Advance(std::chrono::milliseconds(1));
      bus_.Advance(clock_.Now());
      const auto came = bus_.Transmit();
      if (!deaf_) pending_.insert(pending_.end(), came.begin(), came.end());
    }
    if (pending_.empty()) return Errc::kTimeout;
    const std::size_t count = std::min(buffer.size(), pending_.size());
    std::copy_n(pending_.begin(), count, buffer.begin());
    pending_.erase(pending_.begin(), pending_.begin() + static_cast<std::ptrdiff_t>(count));
    return count;
  }
  void Close() override {}

 private:
  sim::Bus& bus_;
  hal::fake::FakeClock& clock_;
  bool deaf_;
  std::deque<std::byte> pending_;
};

}  // namespace facewire::tools

#endif  // FACEWIRE_TESTS_TOOLS_FACEWIRE_SERVO_SIMULATED_PORT_H_
