#ifndef FACEWIRE_APP_ANIMATRONIC_BUS_CONFIG_H_
#define FACEWIRE_APP_ANIMATRONIC_BUS_CONFIG_H_

#include <chrono>
#include <cstdint>
#include <string>

#include "core/base/time.h"
#include "core/bus/feetech_bus.h"
#include "core/bus/guard.h"
#include "core/wire/maestro/maestro.h"

namespace facewire::app {

enum class BusKind : std::uint8_t { kMaestro, kDynamixel, kFeetech, kReceiver };
const char* Name(BusKind kind) noexcept;  // as facewire.toml has it

// One [[bus]] of facewire.toml: a port with servos behind it. Which servos these are, the rig says.
struct ServoBusConfig {
  std::string name;
  BusKind kind = BusKind::kMaestro;
  std::string port;   // "serial:PATH" or "pty:LINK", as host.line
  int baud = 115200;  // DefaultBaud(kind)
  int rate_hz = 50;   // ticks a second, 50 to 200; DefaultRate(kind)
  // A reply that has not come by then is lost.
  Duration reply_timeout = std::chrono::milliseconds(20);
  float feedback_share = 0.25F;  // of the line's time for questions and their replies, 0.01 to 0.9
  Duration refresh = std::chrono::milliseconds(100);  // what does not change is sent again
  bus::GuardConfig guard;                             // of every servo

  wire::maestro::Line maestro;  // Maestro: how its packets are framed
  bool multi_target = false;    // Maestro: a Mini Maestro, not a Micro
  bool answers = true;          // Maestro: its TX is connected
  // Dynamixel: a servo that hears nothing for so long stops by itself; at least three times
  // `refresh`. Zero: as long as the rig's contract lets the last pose stand.
  Duration watchdog{};
  bus::FeetechSeries series = bus::FeetechSeries::kSts;  // Feetech
  bool sync_read = true;                                 // Feetech: it knows that instruction
};

// As the makers deliver the devices.
int DefaultBaud(BusKind kind) noexcept;
// Pulses start every 20 ms; chains are quicker.
int DefaultRate(BusKind kind) noexcept;

// The longest watchdog that Dynamixels have, and how often the refresh has to fit into it.
inline constexpr Duration kLongestWatchdog = std::chrono::milliseconds(2540);
inline constexpr int kRefreshesPerWatchdog = 3;

}  // namespace facewire::app

#endif  // FACEWIRE_APP_ANIMATRONIC_BUS_CONFIG_H_
