#include "app/animatronic/drivers.h"

#include <algorithm>
#include <cstdint>
#include <utility>

#include "app/error.h"

namespace facewire::app {
namespace {

// What a kind of bus can have, in its own unit.
struct Reach {
  const char* ids;  // what they are called
  int first_id, last_id;
  float lowest, highest;
  const char* unit;
};

Reach ReachOf(const ServoBusConfig& bus) {
  switch (bus.kind) {
    case BusKind::kDynamixel:
      return {"ids of Dynamixels", 0, 252, 0, 4095, "counts"};
    case BusKind::kFeetech:
      if (bus.series == bus::FeetechSeries::kScs) {
        return {"ids of Feetech servos", 0, 253, 0, 1023, "counts of an SCS servo"};
      }
      return {"ids of Feetech servos", 0, 253, 0, 4095, "counts"};
    case BusKind::kReceiver:
      return {"outputs of a receiver", 0, static_cast<int>(kMaxServos) - 1, 500, 2500, "us"};
    case BusKind::kMaestro:
      break;
  }
  return {"channels of a Maestro", 0, 23, 64, 4080, "us"};
}

std::string Number(float value) {
  std::string text = std::to_string(value);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text;
}

void CheckServo(const servo::Servo& servo, const ServoBusConfig& bus, std::string& problems) {
  const Reach reach = ReachOf(bus);
  const std::string who =
      "servo \"" + std::string(servo.name.view()) + "\" of bus \"" + bus.name + "\": ";
  Collect(problems, [&] {
    if (servo.id >= reach.first_id && servo.id <= reach.last_id) return;
    throw BadInput(who + "id " + std::to_string(servo.id) + "; " + reach.ids + " are " +
                   std::to_string(reach.first_id) + " to " + std::to_string(reach.last_id));
  });
  Collect(problems, [&] {
    if (servo.min >= reach.lowest && servo.max <= reach.highest) return;
    throw BadInput(who + "min to max is " + Number(servo.min) + " to " + Number(servo.max) +
                   "; such servos take " + Number(reach.lowest) + " to " + Number(reach.highest) +
                   " " + reach.unit);
  });
}

bus::BusConfig BusConfigOf(const ServoBusConfig& config, const servo::ServoRig& rig,
                           const animatronic::Attachment& attachment) {
  bus::BusConfig bus;
  for (const std::size_t servo : attachment.servos) {
    (void)bus.servos.try_push(animatronic::ConfigOf(rig.servos[servo], config.guard));
  }
  bus.baud = static_cast<std::uint32_t>(config.baud);
  bus.reply_timeout = config.reply_timeout;
  bus.feedback_share = config.feedback_share;
  bus.refresh = config.refresh;
  return bus;
}

// For so long the last pose stands when nobody is heard: then a servo stops by itself. The device
// has steps of 20 ms.
Duration WatchdogOf(const ServoBusConfig& config, const servo::Contract& contract) {
  if (config.watchdog > Duration::zero()) return config.watchdog;
  constexpr Duration kStep = std::chrono::milliseconds(20);
  const Duration wanted = std::clamp(contract.fresh + contract.hold,
                                     kRefreshesPerWatchdog * config.refresh, kLongestWatchdog);
  return (wanted + kStep - Duration(1)) / kStep * kStep;
}

Result<> Configure(bus::MaestroBus& driver, const ServoBusConfig& config,
                   const servo::Contract& /*contract*/, const bus::BusConfig& bus) {
  return driver.Configure({.bus = bus,
                           .line = config.maestro,
                           .multi_target = config.multi_target,
                           .answers = config.answers});
}

Result<> Configure(bus::DynamixelBus& driver, const ServoBusConfig& config,
                   const servo::Contract& contract, const bus::BusConfig& bus) {
  bus::DynamixelConfig dynamixel;
  dynamixel.bus = bus;
  dynamixel.watchdog = WatchdogOf(config, contract);
  return driver.Configure(dynamixel);
}

Result<> Configure(bus::FeetechBus& driver, const ServoBusConfig& config,
                   const servo::Contract& /*contract*/, const bus::BusConfig& bus) {
  bus::FeetechConfig feetech;
  feetech.bus = bus;
  feetech.series = config.series;
  feetech.sync_read = config.sync_read;
  return driver.Configure(feetech);
}

Result<> Configure(bus::ReceiverBus& driver, const ServoBusConfig& /*config*/,
                   const servo::Contract& contract, const bus::BusConfig& bus) {
  return driver.Configure(
      {.bus = bus, .hold = contract.hold, .ease = contract.ease, .release = contract.limp});
}

void CheckServos(const std::vector<ServoBusConfig>& buses, const servo::ServoRig& rig,
                 std::string& problems) {
  for (const servo::Servo& servo : rig.servos) {
    const auto bus = std::ranges::find(buses, servo.bus.view(), &ServoBusConfig::name);
    if (bus != buses.end()) {
      CheckServo(servo, *bus, problems);
      continue;
    }
    Collect(problems, [&] {
      const std::string name(servo.bus.view());
      throw BadInput("servo \"" + std::string(servo.name.view()) + "\": there is no bus \"" + name +
                     "\"; the configuration needs a [[bus]] with name = \"" + name + "\"");
    });
  }
}

}  // namespace

Drivers::Drivers(const std::vector<ServoBusConfig>& buses, const servo::ServoRig& rig) {
  std::string problems;
  CheckServos(buses, rig, problems);
  attachments_.reserve(buses.size());
  for (const ServoBusConfig& config : buses) {
    animatronic::Attachment attachment;
    attachment.period = Duration(1'000'000 / config.rate_hz);
    for (std::size_t i = 0; i < rig.servos.size(); ++i) {
      if (rig.servos[i].bus.view() != config.name) continue;
      (void)attachment.servos.try_push(static_cast<std::uint8_t>(i));  // of the same capacity
    }
    Collect(problems, [&] {
      if (!attachment.servos.empty()) return;
      throw BadInput("bus \"" + config.name +
                     "\": no servo of the rig is on it; give one bus = \"" + config.name +
                     "\", or take the [[bus]] out");
    });
    if (!problems.empty()) continue;
    switch (config.kind) {
      case BusKind::kDynamixel:
        drivers_.emplace_back(std::in_place_type<bus::DynamixelBus>);
        break;
      case BusKind::kFeetech:
        drivers_.emplace_back(std::in_place_type<bus::FeetechBus>);
        break;
      case BusKind::kReceiver:
        drivers_.emplace_back(std::in_place_type<bus::ReceiverBus>);
        break;
      case BusKind::kMaestro:
        drivers_.emplace_back(std::in_place_type<bus::MaestroBus>);
        break;
    }
    std::visit(
        [&](auto& driver) {
          const Result<> ok =
              Configure(driver, config, rig.contract, BusConfigOf(config, rig, attachment));
          if (!ok) problems = "bus \"" + config.name + "\": a number is out of its range";
          attachment.driver = &driver;
        },
        drivers_.back());
    attachments_.push_back(attachment);
  }
  if (!problems.empty()) throw BadInput(problems);
}

}  // namespace facewire::app
