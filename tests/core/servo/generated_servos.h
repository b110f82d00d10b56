#ifndef FACEWIRE_TESTS_CORE_SERVO_GENERATED_SERVOS_H_
#define FACEWIRE_TESTS_CORE_SERVO_GENERATED_SERVOS_H_

#include <chrono>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>

#include "core/servo/motion.h"
#include "core/servo/servo_rig.h"

namespace facewire::servo {

inline constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
inline constexpr float kInfinity = std::numeric_limits<float>::infinity();

// A hobby servo of pulses: 1000 to 2000 us, in quarters.
inline Servo PulseServo(std::string_view name, std::uint8_t id) {
  Servo servo;
  servo.name = *ShortName::From(name);
  servo.bus = *ShortName::From("head");
  servo.id = id;
  (void)servo.map.try_push({0, 1000});
  (void)servo.map.try_push({1, 2000});
  servo.min = 1000;
  servo.max = 2000;
  servo.neutral = 1500;
  servo.dead_band = 4;
  servo.max_speed_per_s = 4000;
  servo.max_acceleration_per_s2 = 60000;
  servo.crawl_speed_per_s = 200;
  return servo;
}
inline constexpr Actuator kPulse{.step = 0.25F, .reads_back = false};

// A bus servo with an encoder: 4096 counts a turn.
inline Servo CountServo(std::string_view name, std::uint8_t id) {
  Servo servo = PulseServo(name, id);
  servo.bus = *ShortName::From("chain");
  servo.min = 1024;
  servo.max = 3072;
  servo.neutral = 2048;
  servo.map.clear();
  (void)servo.map.try_push({0, 1024});
  (void)servo.map.try_push({1, 3072});
  servo.dead_band = 8;
  servo.max_speed_per_s = 3000;
  servo.max_acceleration_per_s2 = 30000;
  servo.crawl_speed_per_s = 150;
  return servo;
}
inline constexpr Actuator kCounts{.step = 1, .reads_back = true};

}  // namespace facewire::servo

#endif  // FACEWIRE_TESTS_CORE_SERVO_GENERATED_SERVOS_H_
