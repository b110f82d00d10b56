#ifndef FACEWIRE_APP_ANIMATRONIC_SERVO_REPORT_H_
#define FACEWIRE_APP_ANIMATRONIC_SERVO_REPORT_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <type_traits>

#include "app/animatronic/servo_output.h"
#include "core/base/capacity.h"
#include "core/base/inline_vector.h"
#include "core/base/time.h"
#include "core/bus/servo_bus.h"
#include "core/servo/motion.h"

namespace facewire::app {

// How all servos and their buses are, as the output thread saw them at a moment. Positions are in
// each servo's own unit.
struct ServoReport {
  struct Servo {
    servo::Command command;
    bus::ServoFeedback feedback;
    // It does not answer any more, since then, and had torque when it last did: where its bus has
    // no watchdog, it may go on holding for ever.
    std::optional<Time> stranded;
  };
  struct Bus {
    bus::BusState state = bus::BusState::kStarting;
    bus::BusFault fault = bus::BusFault::kNone;
    PortState port = PortState::kClosed;
    std::optional<Time> closed;  // the port was lost then, and is not back
    PortCounters counters;
    std::uint64_t questions = 0;
    std::uint64_t lost = 0;  // of their replies
    std::uint64_t torque_lost = 0;
    std::uint16_t serial_errors = 0;
  };

  Time at{};
  std::uint64_t ticks = 0;
  std::uint64_t late = 0;  // of them, begun after the next was due
  std::uint8_t servo_count = 0;
  std::uint8_t bus_count = 0;
  std::array<Servo, kMaxServos> servos{};  // in the order of ServoRig::servos
  std::array<Bus, kMaxBuses> buses{};
  bus::Findings findings;  // of all buses; `servo` is an index into ServoRig::servos
};
static_assert(std::is_trivially_copyable_v<ServoReport>);

}  // namespace facewire::app

#endif  // FACEWIRE_APP_ANIMATRONIC_SERVO_REPORT_H_
