#ifndef FACEWIRE_APP_ANIMATRONIC_SERVO_OUTPUT_H_
#define FACEWIRE_APP_ANIMATRONIC_SERVO_OUTPUT_H_

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "app/animatronic/bus_config.h"
#include "app/animatronic/drivers.h"
#include "app/backoff.h"
#include "core/animatronic/animatronic.h"
#include "core/servo/servo_rig.h"
#include "hal/clock.h"
#include "hal/serial_port.h"

namespace facewire::app {

enum class PortState : std::uint8_t { kClosed, kUp, kStuck };
const char* Name(PortState state) noexcept;

// Of a bus's port, since the start.
struct PortCounters {
  std::uint64_t bytes_out = 0;
  std::uint64_t bytes_in = 0;
  std::uint64_t losses = 0;   // times that the open port was lost
  std::uint64_t reopens = 0;  // times that it came back
  std::uint64_t stuck = 0;    // times that it took nothing for kStuckAfter
};

// A character's servos with everything that moves them: drivers, motion and the ports they talk to.
// It has no thread of its own: who has one calls Tick at period().
class ServoOutput {
 public:
  // A port that takes nothing for so long, though there is something for it, is stuck.
  static constexpr Duration kStuckAfter = std::chrono::seconds(1);

  using MakePort = std::function<std::unique_ptr<hal::SerialPort>(const ServoBusConfig&)>;

  // Touches no device. Throws BadInput as Drivers; `clock` is borrowed. The second form is for
  // ports other than those of MakeHostLine.
  ServoOutput(const std::vector<ServoBusConfig>& buses, const servo::ServoRig& rig,
              hal::Clock& clock);
  ServoOutput(const std::vector<ServoBusConfig>& buses, const servo::ServoRig& rig,
              hal::Clock& clock, const MakePort& make_port);

  // Opens all ports. Throws BadInput (not there, busy, no permission: every one on a line of its
  // own), Failure.
  void Open();

  // Reads the ports, moves on, writes. Waits for nothing and allocates nothing, but where a lost
  // port is opened again. What a port takes in part is finished before anything else is said.
  void Tick() noexcept;

  // Lets go of all servos and ticks until they say that they are limp, or for `longest`; then
  // closes the ports.
  void Close(Duration longest) noexcept;

  animatronic::Animatronic& animatronic() noexcept { return animatronic_; }
  const animatronic::Animatronic& animatronic() const noexcept { return animatronic_; }
  Duration period() const noexcept { return animatronic_.period(); }

  // By index of the bus.
  PortState port(std::size_t bus) const noexcept;
  const PortCounters& counters(std::size_t bus) const noexcept { return lines_[bus].counters; }

 private:
  struct Line {
    std::unique_ptr<hal::SerialPort> port;
    std::string address;
    int baud = 0;
    bool open = false;
    bool stuck = false;
    Time taken{};  // when it last took something, or had nothing to take
    Backoff reopen{};
    std::array<std::byte, bus::kMaxTickBytes> rest{};
    std::span<const std::byte> unsent{};  // part of rest
    PortCounters counters{};
  };

  void Reopen(std::size_t bus, Time now) noexcept;
  void Read(std::size_t bus, Time now) noexcept;
  void Write(std::size_t bus, Time now) noexcept;
  // How many bytes the port took.
  std::size_t Push(std::size_t bus, std::span<const std::byte> bytes, Time now) noexcept;
  void Lose(std::size_t bus, Time now) noexcept;
  bool AllSaid() const noexcept;

  hal::Clock& clock_;
  Drivers drivers_;
  animatronic::Animatronic animatronic_;
  std::vector<Line> lines_;
};

}  // namespace facewire::app

#endif  // FACEWIRE_APP_ANIMATRONIC_SERVO_OUTPUT_H_
