#ifndef FACEWIRE_TESTS_APP_ANIMATRONIC_SERVOS_H_
#define FACEWIRE_TESTS_APP_ANIMATRONIC_SERVOS_H_

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "app/animatronic/bus_config.h"
#include "core/servo/servo_rig.h"

// Buses and servos for tests.
namespace facewire::app {

inline ServoBusConfig BusOf(BusKind kind, const std::string& name = "bus") {
  ServoBusConfig bus;
  bus.name = name;
  bus.kind = kind;
  bus.port = "serial:/dev/" + name;
  bus.baud = DefaultBaud(kind);
  bus.rate_hz = DefaultRate(kind);
  return bus;
}

// A jaw in microseconds, or counts where the bus has some: 1000 to 2000, neutral in the middle.
inline servo::Servo ServoOf(const std::string& name, const std::string& bus, int id) {
  servo::Servo servo;
  servo.name = *ShortName::From(name);
  servo.bus = *ShortName::From(bus);
  servo.id = static_cast<std::uint8_t>(id);
  EXPECT_TRUE(servo.sources.try_push({*ShortName::From("jaw.pitch"), 1}));
  EXPECT_TRUE(servo.map.try_push({-5, 1000}));
  EXPECT_TRUE(servo.map.try_push({20, 2000}));
  servo.min = 1000;
  servo.max = 2000;
  servo.neutral = 1500;
  servo.dead_band = 2;
  servo.max_speed_per_s = 4000;
  servo.max_acceleration_per_s2 = 40'000;
  servo.crawl_speed_per_s = 400;
  return servo;
}

inline servo::ServoRig RigOf(const std::vector<servo::Servo>& servos) {
  servo::ServoRig rig;
  for (const servo::Servo& servo : servos) EXPECT_TRUE(rig.servos.try_push(servo));
  return rig;
}

}  // namespace facewire::app

#endif  // FACEWIRE_TESTS_APP_ANIMATRONIC_SERVOS_H_
