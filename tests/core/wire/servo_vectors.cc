#include <cstdint>
#include <initializer_list>
#include <vector>

#include "core/wire/message.h"
#include "tests/core/wire/raw_frame.h"
#include "tests/core/wire/vector_line.h"

namespace facewire::wire {
namespace {

constexpr std::uint32_t kId = 0x1234ABCD;

ServoSetup SomeSetup(std::size_t servos) {
  ServoSetup setup{.setup_id = kId, .hold_ms = 400, .ease_ms = 1500, .release_ms = 60'000};
  (void)setup.servos.try_resize(servos);
  for (std::size_t i = 0; i < servos; ++i) {
    const auto step = static_cast<std::uint16_t>(4 * i);
    setup.servos[i] = {.min_quarter_us = static_cast<std::uint16_t>(4000 - step),
                       .neutral_quarter_us = static_cast<std::uint16_t>(6000 + step),
                       .max_quarter_us = static_cast<std::uint16_t>(8000 + step),
                       .speed_us_s = static_cast<std::uint16_t>(6000 + i),
                       .ramp_speed_us_s = static_cast<std::uint16_t>(200 + i),
                       .ramp_acceleration_10us_s2 = static_cast<std::uint16_t>(40 + i)};
  }
  return setup;
}

ServoPulses SomePulses(std::size_t servos) {
  ServoPulses pulses{.setup_id = kId};
  (void)pulses.quarter_us.try_resize(servos);
  for (std::size_t i = 0; i < servos; ++i) {
    pulses.quarter_us[i] = static_cast<std::uint16_t>(6000 + 17 * i);
  }
  return pulses;
}

void AddSoundServos(std::vector<Vector>& all) {
  const auto add = [&](const char* name, const char* about, const Message& message) {
    all.push_back({name, about, Line().Send(message)});
  };
  add("servo_setup", "What a receiver of twelve servos must know", SomeSetup(12));
  add("servo_setup_empty", "A setup without servos, extreme times",
      ServoSetup{.setup_id = 0xFFFFFFFF, .hold_ms = 0, .ease_ms = 0, .release_ms = 0xFFFFFFFF});
  add("servo_setup_64", "As many servos as there may be", SomeSetup(kMaxServos));
  ServoSetup fixed{.setup_id = 1};
  (void)fixed.servos.try_push({.min_quarter_us = kMinPulseQuarterUs,
                               .neutral_quarter_us = kMinPulseQuarterUs,
                               .max_quarter_us = kMinPulseQuarterUs,
                               .speed_us_s = 1,
                               .ramp_speed_us_s = 1,
                               .ramp_acceleration_10us_s2 = 1});
  (void)fixed.servos.try_push({.min_quarter_us = kMinPulseQuarterUs,
                               .neutral_quarter_us = kMaxPulseQuarterUs,
                               .max_quarter_us = kMaxPulseQuarterUs,
                               .speed_us_s = 0xFFFF,
                               .ramp_speed_us_s = 0xFFFF,
                               .ramp_acceleration_10us_s2 = 0xFFFF});
  add("servo_setup_extremes", "One servo that cannot move, one with all there is", fixed);
  add("servo_pulses", "Twelve servos: 40 bytes on the line", SomePulses(12));
  add("servo_pulses_64", "As many servos as there may be", SomePulses(kMaxServos));
  ServoPulses stop = SomePulses(3);
  stop.stop = true;
  stop.quarter_us[1] = 0;
  add("servo_pulses_stop", "Emergency stop; the second of three servos goes limp", stop);
  ReceiverStatus status{.setup_id = kId,
                        .state = ReceiverState::kFollowing,
                        .capacity = 12,
                        .version_major = 1,
                        .version_minor = 2,
                        .reset_causes = kResetWatchdog | kResetBrownOut,
                        .supply_mv = 4973,
                        .uptime_ms = 86'400'123,
                        .frames = 4'320'001,
                        .damaged = 7,
                        .lost = 8,
                        .refused = 9};
  for (const int width : {6000, 0, 2000, 10000}) {
    (void)status.quarter_us.try_push(static_cast<std::uint16_t>(width));
  }
  add("receiver_status", "A receiver's status with every field different", status);
  add("receiver_status_waiting", "A receiver that just woke up", ReceiverStatus{.capacity = 12});

  Line device;
  Bytes session = device.Send(SomeSetup(12));
  for (int i = 0; i < 3; ++i) {
    ServoPulses pulses = SomePulses(12);
    for (std::uint16_t& width : pulses.quarter_us) width = static_cast<std::uint16_t>(width + i);
    session = session + device.Send(pulses);
  }
  all.push_back({"servo_session", "A setup, then pulses three times", session});
}

void AddMalformedServos(std::vector<Vector>& all) {
  const auto malformed = [&](const char* name, const char* about, int type, const Bytes& payload) {
    all.push_back({name, about, RawFrame(kVersion, type, 0, payload)});
  };
  const auto setup = [](int id, std::initializer_list<int> values) {
    Bytes payload = MakeBytes({id, 0, 0, 0}) + Bytes(12, std::byte{1}) + MakeBytes({1});
    for (const int value : values) payload = payload + MakeBytes({value & 0xFF, value >> 8});
    return payload;
  };
  malformed("malformed_setup_id", "A setup with the id that means none", 0x14,
            setup(0, {4000, 6000, 8000, 1, 1, 1}));
  malformed("malformed_setup_order", "A setup whose neutral is above its max", 0x14,
            setup(1, {4000, 8001, 8000, 1, 1, 1}));
  malformed("malformed_setup_min", "A setup that allows pulses below 500 us", 0x14,
            setup(1, {1999, 6000, 8000, 1, 1, 1}));
  malformed("malformed_setup_max", "A setup that allows pulses above 2500 us", 0x14,
            setup(1, {4000, 6000, 10001, 1, 1, 1}));
  malformed("malformed_setup_speed", "A setup with a speed of 0", 0x14,
            setup(1, {4000, 6000, 8000, 0, 1, 1}));
  malformed("malformed_setup_ramp_speed", "A setup with a speed of 0 for ramps", 0x14,
            setup(1, {4000, 6000, 8000, 1, 0, 1}));
  malformed("malformed_setup_ramp_acceleration", "A setup with an acceleration of 0", 0x14,
            setup(1, {4000, 6000, 8000, 1, 1, 0}));
  malformed("malformed_setup_short", "A setup whose last servo is cut off", 0x14,
            setup(1, {4000, 6000, 8000, 1, 1}));
  malformed("malformed_setup_count", "A setup of 65 servos", 0x14,
            MakeBytes({1, 0, 0, 0}) + Bytes(12, std::byte{1}) + MakeBytes({65}) +
                Bytes(std::size_t{65} * 12, std::byte{0x10}));
  malformed("malformed_pulses_low", "A pulse of 499.75 us", 0x15,
            MakeBytes({1, 0, 0, 0, 0, 2, 0x70, 0x17, 0xCF, 0x07}));
  malformed("malformed_pulses_high", "A pulse of 2500.25 us", 0x15,
            MakeBytes({1, 0, 0, 0, 0, 2, 0x11, 0x27, 0x70, 0x17}));
  malformed("malformed_pulses_short", "Two servos promised, one and a half there", 0x15,
            MakeBytes({1, 0, 0, 0, 0, 2, 0x70, 0x17, 0x70}));
  malformed("malformed_pulses_count", "Pulses of 65 servos", 0x15,
            MakeBytes({1, 0, 0, 0, 0, 65}) + Bytes(130, std::byte{0x10}));
  malformed("malformed_receiver_status", "A receiver's status without its count", 0x81,
            Bytes(31, std::byte{0}));
  malformed("malformed_receiver_capacity", "A receiver of 65 servos", 0x81,
            MakeBytes({0, 0, 0, 0, 0, 65}) + Bytes(26, std::byte{0}));
}

}  // namespace

void AddServos(std::vector<Vector>& all) {
  AddSoundServos(all);
  AddMalformedServos(all);
}

}  // namespace facewire::wire
