#include "tests/tools/firmware/firmware_bus.h"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <span>

namespace facewire::firmware {
namespace {

constexpr double kMiddleUs = 1500;
constexpr double kRadPerUs = 90 * sim::kDegree / 1000;  // a servo's 180 degrees are 2000 us
constexpr unsigned kTickAt = 8;                         // ms after a period began, as in avr/
constexpr std::uint16_t kTicksPerMs = 2000;             // of an edge's time
constexpr std::uint16_t kSupplyMillivolts = 5000;
constexpr int kRandomMemory = 0xA5;  // what is in it after a power-on
constexpr std::uint8_t kPowerOn = 1;
constexpr std::uint8_t kResetPin = 2;
// A servo that gets no pulse for two periods lets go.
constexpr unsigned kLetsGo = 2;

}  // namespace

FirmwareBus::FirmwareBus(const FirmwareBusOptions& options)
    : Bus(options, FW_SERVOS, kMiddleUs, 1 / kRadPerUs, /*half_duplex=*/false) {
  std::memset(&retained_, kRandomMemory, sizeof retained_);
  Start();
}

double FirmwareBus::ToOwn(double rad) const { return kMiddleUs + rad / kRadPerUs; }
double FirmwareBus::ToRad(double own) const { return (own - kMiddleUs) * kRadPerUs; }

void FirmwareBus::Start() {
  FwDecoderInit(&decoder_);
  FwReceiverInit(&receiver_, FwRemember(&retained_));
  planned_.fill(0);
  for (Output& output : outputs_) output.pulsed = false;
  millisecond_ = 0;
  StartPeriod();
}

void FirmwareBus::Reset(Duration takes) {
  Happened(sim::EventKind::kReboot, sim::kWholeBus, 0);
  reset_causes_ = kResetPin;
  booting_ = takes;
  Start();
}

void FirmwareBus::PowerCycle(Duration takes) {
  std::memset(&retained_, kRandomMemory, sizeof retained_);
  Reset(takes);
  reset_causes_ = kPowerOn;
}

void FirmwareBus::OnByte(std::uint8_t byte, sim::Nanos /*at*/) {
  if (booting_ > Duration{}) return;
  FwFrame frame;
  const std::uint32_t damaged = FwDamaged(&decoder_.stats);
  if (FwDecoderTake(&decoder_, byte, &frame)) FwReceiverTake(&receiver_, &frame);
  if (FwDamaged(&decoder_.stats) != damaged) {
    Happened(sim::EventKind::kDamagedPacket, sim::kWholeBus, 0);
  }
}

void FirmwareBus::StartPeriod() {
  for (std::size_t i = 0; i < outputs_.size(); ++i) {
    Output& output = outputs_[i];
    if (output.pulsed) {
      output.missing = 0;
    } else {
      output.width = 0;
      if (++output.missing >= kLetsGo) servo(i).Release();
    }
    output.pulsed = false;
  }
  FwPlanEdges(planned_.data(), edges_.data());
  next_edge_ = 0;
}

// The edges until then; a servo knows its pulse when that has ended.
void FirmwareBus::RunEdges(std::uint16_t until) {
  for (; edges_[next_edge_].what != kFwPeriodEnd && edges_[next_edge_].at <= until; ++next_edge_) {
    const FwEdge& edge = edges_[next_edge_];
    const std::size_t i = edge.what & 0x0FU;
    if ((edge.what & kFwRise) != 0) {
      rose_at_[i] = edge.at;
      continue;
    }
    outputs_[i].width = static_cast<std::uint16_t>(edge.at - rose_at_[i]);
    outputs_[i].pulsed = true;
    if (Running(i)) servo(i).GoTo(ToRad(outputs_[i].width / 2.0));
  }
}

void FirmwareBus::Tick(Time at) {
  const FwState before = receiver_.state;
  FwDecoderTick(&decoder_);
  FwReceiverTick(&receiver_);
  if (receiver_.state == kFwEasing && before != kFwEasing) {
    Happened(sim::EventKind::kWatchdog, sim::kWholeBus, static_cast<int>(receiver_.setup.hold_ms));
  }
  std::array<std::uint16_t, FW_SERVOS> positions;
  for (std::uint8_t i = 0; i < FW_SERVOS; ++i) {
    planned_[i] = FwReceiverPulse(&receiver_, i);
    positions[i] = FwReceiverPosition(&receiver_, i);
  }
  FwRetain(&retained_, static_cast<std::uint8_t>(receiver_.ticks), positions.data());
  const sim::Nanos now = at.time_since_epoch() / std::chrono::nanoseconds(1);
  if (!FwReceiverStatusDue(&receiver_) || now < line_free_) return;
  std::array<std::uint8_t, FW_STATUS_FRAME_BYTES> frame;
  const std::size_t size = FwReceiverWriteStatus(&receiver_, &decoder_.stats, reset_causes_,
                                                 kSupplyMillivolts, frame.data());
  line_free_ = Reply(std::span(frame).first(size), now, 0);
}

void FirmwareBus::OnMillisecond(Time at) {
  if (booting_ > Duration{}) booting_ -= std::chrono::milliseconds(1);
  RunEdges(static_cast<std::uint16_t>(++millisecond_ * kTicksPerMs));
  if (millisecond_ == kTickAt && booting_ <= Duration{}) Tick(at);
  if (millisecond_ < FW_TICK_MS) return;
  millisecond_ = 0;
  StartPeriod();
}

}  // namespace facewire::firmware
