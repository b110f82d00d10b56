#include "tests/tools/firmware/firmware_line.h"

#include <array>
#include <span>
#include <variant>

#include "core/wire/decoder.h"
#include "tests/core/wire/json.h"
#include "tests/tools/firmware/firmware.h"

namespace facewire::firmware {
namespace {

constexpr const char* kTooMany = "too many servos";

wire::ServoSetup ToMessage(const FwSetup& setup) {
  wire::ServoSetup m{.setup_id = setup.id,
                     .hold_ms = setup.hold_ms,
                     .ease_ms = setup.ease_ms,
                     .release_ms = setup.release_ms};
  for (std::size_t i = 0; i < setup.count; ++i) {
    const FwServo& servo = setup.servos[i];
    (void)m.servos.try_push({.min_quarter_us = servo.min,
                             .neutral_quarter_us = servo.neutral,
                             .max_quarter_us = servo.max,
                             .speed_us_s = servo.speed,
                             .ramp_speed_us_s = servo.ramp_speed,
                             .ramp_acceleration_10us_s2 = servo.ramp_acceleration});
  }
  return m;
}

wire::ServoPulses ToMessage(const FwPulses& pulses) {
  wire::ServoPulses m{.setup_id = pulses.setup_id, .stop = pulses.stop};
  for (std::size_t i = 0; i < pulses.count; ++i) (void)m.quarter_us.try_push(pulses.width[i]);
  return m;
}

template <class Read, class Content>
void AddMessage(const FwFrame& frame, Read read, Content& content, Reading& reading) {
  switch (read(frame.payload, frame.size, &content)) {
    case kFwOk:
      reading.messages.push_back(
          wire::ToJson({.sequence = frame.sequence, .message = ToMessage(content)}));
      break;
    case kFwTooMany:
      reading.messages.push_back(kTooMany);
      break;
    case kFwMalformed:
      break;
  }
}

}  // namespace

Bytes Line::Send(const wire::Message& message) {
  std::array<std::byte, wire::kMaxFrameBytes> buffer;
  const auto frame = encoder_.Encode(message, buffer).value();
  return {frame.begin(), frame.end()};
}

wire::ServoSetup TwelveServos(std::uint32_t setup_id) {
  wire::ServoSetup setup{.setup_id = setup_id, .hold_ms = 200, .ease_ms = 400, .release_ms = 300};
  (void)setup.servos.try_resize(FW_SERVOS);
  for (wire::ServoLimits& servo : setup.servos) {
    servo.speed_us_s = 4000;
    servo.ramp_speed_us_s = 500;
    servo.ramp_acceleration_10us_s2 = 200;
  }
  return setup;
}

wire::ServoPulses AllAt(int us, std::uint32_t setup_id) {
  wire::ServoPulses pulses{.setup_id = setup_id};
  (void)pulses.quarter_us.try_resize(FW_SERVOS);
  for (std::uint16_t& width : pulses.quarter_us) width = static_cast<std::uint16_t>(4 * us);
  return pulses;
}

Reading ReadByFirmware(const Bytes& stream) {
  FwDecoder decoder;
  FwDecoderInit(&decoder);
  Reading reading;
  for (const std::byte byte : stream) {
    FwFrame frame;
    if (!FwDecoderTake(&decoder, std::to_integer<std::uint8_t>(byte), &frame)) continue;
    if (frame.type == kFwServoSetup) {
      FwSetup setup;
      AddMessage(frame, FwReadSetup, setup, reading);
    } else if (frame.type == kFwServoPulses) {
      FwPulses pulses;
      AddMessage(frame, FwReadPulses, pulses, reading);
    }
  }
  const FwLinkStats& s = decoder.stats;
  reading.counts = {s.sound,     s.versions, s.crc_errors, s.cobs_errors, s.truncated,
                    s.overflows, s.lost,     s.restarts,   s.resyncs,     FwDamaged(&s)};
  return reading;
}

Reading ReadByDevice(const Bytes& stream) {
  wire::Decoder decoder;
  Reading reading;
  std::span<const std::byte> rest(stream);
  for (;;) {
    const auto received = decoder.Next(rest);
    if (!received) {
      if (received.error() == Errc::kNotReady) break;
      continue;
    }
    const auto* setup = std::get_if<wire::ServoSetup>(&received->message);
    const auto* pulses = std::get_if<wire::ServoPulses>(&received->message);
    if (setup == nullptr && pulses == nullptr) continue;
    const std::size_t servos = setup != nullptr ? setup->servos.size() : pulses->quarter_us.size();
    reading.messages.push_back(servos > FW_SERVOS ? kTooMany : wire::ToJson(*received));
  }
  const wire::LinkStats& s = decoder.stats();
  // The firmware looks only into messages for a receiver, so it counts all sound frames as one.
  reading.counts = {s.frames + s.unknown + s.malformed,
                    s.versions,
                    s.crc_errors,
                    s.cobs_errors,
                    s.truncated,
                    s.overflows,
                    s.lost,
                    s.restarts,
                    s.resyncs,
                    s.Damaged()};
  return reading;
}

}  // namespace facewire::firmware
