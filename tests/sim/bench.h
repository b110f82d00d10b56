#ifndef FACEWIRE_TESTS_SIM_BENCH_H_
#define FACEWIRE_TESTS_SIM_BENCH_H_

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "tests/sim/bus.h"

namespace facewire::sim {

using Bytes = std::vector<std::uint8_t>;
using std::chrono::milliseconds;

inline std::vector<std::byte> Raw(const Bytes& bytes) {
  std::vector<std::byte> raw;
  for (const std::uint8_t b : bytes) raw.push_back(std::byte{b});
  return raw;
}

inline Bytes Plain(const std::vector<std::byte>& raw) {
  Bytes bytes;
  for (const std::byte b : raw) bytes.push_back(std::to_integer<std::uint8_t>(b));
  return bytes;
}

// "FF 01 2A" as bytes, so that tests show packets as manuals print them.
inline Bytes Hex(const std::string& text) {
  Bytes bytes;
  for (std::size_t at = 0; at + 1 < text.size(); at += 3) {
    bytes.push_back(static_cast<std::uint8_t>(std::stoi(text.substr(at, 2), nullptr, 16)));
  }
  return bytes;
}

inline Bytes operator+(Bytes a, const Bytes& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

// A bus on a test's bench: a host that writes bytes and waits in virtual time.
template <class SomeBus>
class Bench {
 public:
  template <class... Arguments>
  explicit Bench(Arguments&&... arguments) : bus(std::forward<Arguments>(arguments)...) {
    bus.Advance(now);
  }

  void Send(const Bytes& bytes) { bus.Receive(Raw(bytes), now); }
  void Wait(Duration time) {
    now += time;
    bus.Advance(now);
  }
  // What comes back within `time`.
  Bytes Ask(const Bytes& bytes, Duration time = milliseconds(50)) {
    bus.Transmit();
    Send(bytes);
    Wait(time);
    return Plain(bus.Transmit());
  }
  // How long until `position` is reached from below (in the servo's own unit).
  Duration TimeTo(std::size_t servo, double position, Duration most = std::chrono::seconds(10)) {
    const Time start = now;
    while (bus.Position(servo) < position && now < start + most) Wait(milliseconds(1));
    return now - start;
  }
  std::size_t Count(EventKind kind) { return bus.trace().Count(kind); }

  SomeBus bus;
  Time now{};
};

}  // namespace facewire::sim

#endif  // FACEWIRE_TESTS_SIM_BENCH_H_
