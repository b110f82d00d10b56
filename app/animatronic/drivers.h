#ifndef FACEWIRE_APP_ANIMATRONIC_DRIVERS_H_
#define FACEWIRE_APP_ANIMATRONIC_DRIVERS_H_

#include <cstddef>
#include <deque>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "app/animatronic/bus_config.h"
#include "core/animatronic/animatronic.h"
#include "core/bus/dynamixel_bus.h"
#include "core/bus/feetech_bus.h"
#include "core/bus/maestro_bus.h"
#include "core/bus/receiver_bus.h"
#include "core/servo/servo_rig.h"

namespace facewire::app {

// The drivers of a character's buses, each told about the servos that hang on it.
class Drivers {
 public:
  // Throws BadInput with every problem on a line of its own: a servo whose bus is not there, a bus
  // without servos, an id or a range that this kind of bus cannot have. Both are copied from.
  Drivers(const std::vector<ServoBusConfig>& buses, const servo::ServoRig& rig);
  Drivers(const Drivers&) = delete;
  Drivers& operator=(const Drivers&) = delete;

  // In the order of `buses`.
  std::span<const animatronic::Attachment> attachments() const noexcept { return attachments_; }

 private:
  using Driver = std::variant<bus::MaestroBus, bus::DynamixelBus, bus::FeetechBus, bus::ReceiverBus>;

  std::deque<Driver> drivers_;  // they stay where they are
  std::vector<animatronic::Attachment> attachments_;
};

}  // namespace facewire::app

#endif  // FACEWIRE_APP_ANIMATRONIC_DRIVERS_H_
