#include "tests/tools/firmware/avr_bus.h"

#include <chrono>
#include <span>

namespace facewire::firmware {
namespace {

constexpr double kMiddleUs = 1500;
constexpr double kRadPerUs = 90 * sim::kDegree / 1000;  // a servo's 180 degrees are 2000 us
// A pulse that has not come by then is missing, and a servo that misses two lets go.
constexpr double kMissingMs = 25;
constexpr double kLetsGoMs = 45;

sim::BusOptions AtItsRate(sim::BusOptions options) {
  options.baud = 115'200;
  return options;
}

}  // namespace

AvrBus::AvrBus(const sim::BusOptions& options, std::size_t servos)
    : Bus(AtItsRate(options), servos, kMiddleUs, 1 / kRadPerUs, /*half_duplex=*/false),
      outputs_(servos) {
  FwDecoderInit(&listener_);
}

double AvrBus::ToOwn(double rad) const { return kMiddleUs + rad / kRadPerUs; }
double AvrBus::ToRad(double own) const { return (own - kMiddleUs) * kRadPerUs; }

void AvrBus::OnByte(std::uint8_t byte, sim::Nanos /*at*/) {
  const std::byte raw{byte};
  board_.Send(std::span(&raw, 1));
  FwFrame frame;
  if (!FwDecoderTake(&listener_, byte, &frame) || frame.type != kFwServoPulses) return;
  FwPulses pulses{};
  if (FwReadPulses(frame.payload, frame.size, &pulses) == kFwOk) asked_ = pulses;
}

void AvrBus::MoveServo(std::size_t index) {
  Output& output = outputs_[index];
  const auto pulses = board_.TakePulses(index);
  if (!pulses.empty()) {
    output = {.width_us = pulses.back().width_us, .ended_ms = board_.now_ms()};
    if (Running(index)) servo(index).GoTo(ToRad(output.width_us));
    return;
  }
  const double since_ms = board_.now_ms() - output.ended_ms;
  if (since_ms > kMissingMs) output.width_us = 0;
  if (since_ms > kLetsGoMs) servo(index).Release();
}

void AvrBus::OnMillisecond(Time at) {
  board_.RunFor(1);
  for (std::size_t i = 0; i < outputs_.size(); ++i) MoveServo(i);
  for (std::size_t i = outputs_.size(); i < SimulatedBoard::kServos; ++i) {
    (void)board_.TakePulses(i);
  }
  (void)board_.TakeBusy();
  (void)board_.TakeStatus();
  std::vector<std::uint8_t> said;
  for (const std::byte byte : board_.TakeBytes()) {
    said.push_back(std::to_integer<std::uint8_t>(byte));
  }
  if (!said.empty()) Reply(said, at.time_since_epoch() / std::chrono::nanoseconds(1), 0);
}

}  // namespace facewire::firmware
