#ifndef FACEWIRE_TESTS_APP_SLOW_PORT_H_
#define FACEWIRE_TESTS_APP_SLOW_PORT_H_

#include <algorithm>
#include <vector>

#include "hal/clock.h"
#include "hal/serial_port.h"

namespace facewire::app {

// A UART in virtual time: the system takes 4 KiB at once and lets them go at the bit rate.
class SlowPort final : public hal::SerialPort {
 public:
  struct Arrival {
    Time at{};  // the byte's last bit
    std::byte byte{};
  };

  SlowPort(hal::Clock& clock, int baud) : clock_(clock), byte_time_(10'000'000 / baud) {}

  Result<> Open() override { return {}; }
  Result<std::size_t> Write(std::span<const std::byte> bytes,
                            std::chrono::milliseconds /*timeout*/) override {
    const std::size_t taken = std::min(bytes.size(), kQueue - Unsent());
    if (taken == 0) return Errc::kTimeout;
    Time leaves = arrivals.empty() ? clock_.Now() : std::max(clock_.Now(), arrivals.back().at);
    for (const std::byte b : bytes.first(taken)) {
      leaves += byte_time_;
      arrivals.push_back({leaves, b});
    }
    return taken;
  }
  Result<std::size_t> Read(std::span<std::byte> /*buffer*/,
                           std::chrono::milliseconds /*timeout*/) override {
    return Errc::kTimeout;
  }
  std::size_t Unsent() override {
    const auto left = [this](const Arrival& a) { return a.at <= clock_.Now(); };
    return static_cast<std::size_t>(arrivals.end() -
                                    std::partition_point(arrivals.begin(), arrivals.end(), left));
  }
  void Close() override {}

  std::vector<Arrival> arrivals;

 private:
  static constexpr std::size_t kQueue = 4096;

  hal::Clock& clock_;
  Duration byte_time_;
};

}  // namespace facewire::app

#endif  // FACEWIRE_TESTS_APP_SLOW_PORT_H_
