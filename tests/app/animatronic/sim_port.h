#ifndef FACEWIRE_TESTS_APP_ANIMATRONIC_SIM_PORT_H_
#define FACEWIRE_TESTS_APP_ANIMATRONIC_SIM_PORT_H_

#include <algorithm>
#include <cstddef>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "hal/clock.h"
#include "hal/serial_port.h"
#include "tests/sim/bus.h"

namespace facewire::app {

// The far end of a port in virtual time: a simulated bus, a plug that can be pulled, and a buffer
// that can be full.
struct SimEnd {
  static constexpr std::size_t kUnlimited = std::numeric_limits<std::size_t>::max();

  sim::Bus& bus;
  hal::Clock& clock;
  bool plugged = true;
  std::size_t room = kUnlimited;  // that the port still takes
  int opens = 0;
  std::vector<std::byte> written{};
  std::vector<std::byte> incoming{};

  void Advance() {
    bus.Advance(clock.Now());
    const std::vector<std::byte> said = bus.Transmit();
    if (plugged) incoming.insert(incoming.end(), said.begin(), said.end());
  }
};

class SimPort final : public hal::SerialPort {
 public:
  explicit SimPort(SimEnd& end) : end_(end) {}

  Result<> Open() override {
    if (!end_.plugged) return Errc::kNotFound;
    ++end_.opens;
    open_ = true;
    return {};
  }
  Result<std::size_t> Write(std::span<const std::byte> bytes,
                            std::chrono::milliseconds /*timeout*/) override {
    if (!open_ || !end_.plugged) return Errc::kDisconnected;
    const std::size_t taken = std::min(bytes.size(), end_.room);
    if (taken == 0) return Errc::kTimeout;
    if (end_.room != SimEnd::kUnlimited) end_.room -= taken;
    end_.bus.Receive(bytes.first(taken), end_.clock.Now());
    end_.written.insert(end_.written.end(), bytes.begin(), bytes.begin() + taken);
    return taken;
  }
  Result<std::size_t> Read(std::span<std::byte> buffer,
                           std::chrono::milliseconds /*timeout*/) override {
    if (!open_ || !end_.plugged) return Errc::kDisconnected;
    end_.Advance();
    const std::size_t count = std::min(buffer.size(), end_.incoming.size());
    if (count == 0) return Errc::kTimeout;
    std::copy_n(end_.incoming.begin(), count, buffer.begin());
    end_.incoming.erase(end_.incoming.begin(), end_.incoming.begin() + count);
    return count;
  }
  void Close() override { open_ = false; }

 private:
  SimEnd& end_;
  bool open_ = false;
};

}  // namespace facewire::app

#endif  // FACEWIRE_TESTS_APP_ANIMATRONIC_SIM_PORT_H_
