#include "tests/sim/bus.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace facewire::sim {
namespace {

constexpr Duration kMillisecond{1000};
// A supply's dip after which a servo starts anew lasts long enough for its capacitors.
constexpr Duration kBrownOutTakes{300'000};

Nanos ToNanos(Time time) { return time.time_since_epoch().count() * 1000; }
// Rounded up: at this microsecond it has happened.
Time FromNanos(Nanos nanos) { return Time(Duration((nanos + 999) / 1000)); }

bool IsLater(const Fault& a, const Fault& b) { return a.at > b.at; }

}  // namespace

Bus::Bus(const BusOptions& options, std::size_t servos, double middle, double own_per_rad,
         bool half_duplex)
    : line_(options.baud, half_duplex, options.echo, options.faults.line, options.seed),
      open_supply_V_(options.supply_V),
      supply_ohm_(options.supply_ohm),
      voltage_V_(options.supply_V),
      own_per_rad_(own_per_rad) {
  for (std::size_t i = 0; i < servos; ++i) {
    const double pose = i < options.poses.size() ? options.poses[i] : middle;
    models_.emplace_back(options.servo, i < options.loads.size() ? options.loads[i] : ServoLoad{},
                         (pose - middle) / own_per_rad, options.seed + 1000 + i);
  }
  conditions_.resize(servos);
  std::copy_if(options.faults.faults.begin(), options.faults.faults.end(),
               std::back_inserter(coming_), [&](const Fault& f) { return f.servo < servos; });
  std::stable_sort(coming_.begin(), coming_.end(), IsLater);
}

void Bus::Inject(const Fault& fault) {
  if (fault.servo >= models_.size()) return;
  coming_.insert(std::upper_bound(coming_.begin(), coming_.end(), fault, IsLater), fault);
}

void Bus::Advance(Time now) {
  if (!started_) {
    started_ = true;
    start_ = now_ = now;
    tick_ = now + kMillisecond;
  }
  while (true) {
    const Time byte_at =
        line_.NextAtServos() == Line::kNever ? Time::max() : FromNanos(line_.NextAtServos());
    if (byte_at <= now && byte_at <= tick_) {
      now_ = std::max(now_, byte_at);
      const Line::Byte byte = line_.TakeAtServos();
      OnByte(byte.value, byte.end);
    } else if (tick_ <= now) {
      now_ = tick_;
      Millisecond();
      tick_ += kMillisecond;
    } else {
      break;
    }
    for (int i = line_.TakeCollisions(); i > 0; --i) Happened(EventKind::kCollision, kWholeBus, 0);
  }
  now_ = std::max(now_, now);
}

void Bus::Receive(std::span<const std::byte> bytes, Time now) {
  Advance(now);
  line_.FromHost(bytes, ToNanos(now_));
  for (int i = line_.TakeCollisions(); i > 0; --i) Happened(EventKind::kCollision, kWholeBus, 0);
}

std::vector<std::byte> Bus::Transmit() {
  std::vector<std::byte> bytes;
  line_.TakeAtHost(ToNanos(now_), bytes);
  return bytes;
}

Time Bus::NextTransmit() const {
  return line_.NextAtHost() == Line::kNever ? Time::max() : FromNanos(line_.NextAtHost());
}

void Bus::Millisecond() {
  RunFaults();
  for (std::size_t i = 0; i < models_.size(); ++i) {
    Condition& condition = conditions_[i];
    if (condition.starting && condition.powered && condition.starts <= now_) {
      condition.starting = false;
      OnPowerUp(i);
    }
  }
  OnMillisecond(now_);
  double current_A = 0;
  for (std::size_t i = 0; i < models_.size(); ++i) {
    models_[i].Step(voltage_V_);
    if (conditions_[i].powered) current_A += models_[i].supply_current_A();
  }
  // The supply's own capacitors make it follow within some milliseconds.
  const double wanted_V = std::max(0.0, open_supply_V_ - supply_ohm_ * current_A);
  voltage_V_ += (wanted_V - voltage_V_) * 0.3;
  Record();
  line_.Noise(ToNanos(now_), 1'000'000);
}

void Bus::Record() {
  for (std::size_t i = 0; i < models_.size(); ++i) {
    const ServoModel& model = models_[i];
    Condition& condition = conditions_[i];
    if (model.burnt() && !condition.burnt) {
      condition.burnt = true;
      Happened(EventKind::kBurnt, static_cast<int>(i), static_cast<int>(model.temperature_C()));
    }
    if (condition.powered && !condition.starting && voltage_V_ < model.parameters().brown_out_V) {
      Happened(EventKind::kBrownOut, static_cast<int>(i), static_cast<int>(voltage_V_ * 10));
      StartAnew(i, kBrownOutTakes);
    }
    if (model.driven() != condition.driven) {
      condition.driven = model.driven();
      Happened(condition.driven ? EventKind::kTorqueOn : EventKind::kTorqueOff, static_cast<int>(i),
               0);
    }
    trace_.Add(Sample{.at = now_,
                      .servo = static_cast<int>(i),
                      .torque_on = model.driven(),
                      .goal = static_cast<float>(Goal(i)),
                      .commanded = static_cast<float>(Commanded(i)),
                      .position = static_cast<float>(Position(i)),
                      .speed = static_cast<float>(model.speed_radps() * own_per_rad_),
                      .current_A = static_cast<float>(model.current_A()),
                      .temperature_C = static_cast<float>(model.temperature_C()),
                      .torque_Nm = static_cast<float>(model.torque_Nm()),
                      .voltage_V = static_cast<float>(voltage_V_)});
  }
}

bool Bus::Running(std::size_t index) const {
  return conditions_[index].powered && !conditions_[index].starting;
}

void Bus::StartAnew(std::size_t index, Duration takes) {
  models_[index].Release();
  conditions_[index].starting = true;
  conditions_[index].starts = now_ + takes;
}

Nanos Bus::Reply(std::span<const std::uint8_t> bytes, Nanos at, Nanos delay) {
  return line_.FromServo(bytes, at + delay);
}

void Bus::Happened(EventKind kind, int servo, int detail) {
  trace_.Add(Event{now_, servo, kind, detail});
}

void Bus::RunFaults() {
  const Duration age = now_ - start_;
  while (!coming_.empty() && coming_.back().at <= age) {
    const Fault fault = coming_.back();
    coming_.pop_back();
    Begin(fault);
    if (fault.lasts > Duration{}) present_.push_back(fault);
  }
  const auto over = std::stable_partition(present_.begin(), present_.end(),
                                          [&](const Fault& f) { return f.at + f.lasts > age; });
  const std::vector<Fault> ended(over, present_.end());
  present_.erase(over, present_.end());
  for (const Fault& fault : ended) End(fault);
}

void Bus::Begin(const Fault& fault) {
  const auto index = static_cast<int>(fault.servo);
  Condition& condition = conditions_[fault.servo];
  ServoModel& model = models_[fault.servo];
  Happened(EventKind::kFault, index, static_cast<int>(fault.kind));
  switch (fault.kind) {
    case FaultKind::kVanish:
      condition.powered = false;
      StartAnew(fault.servo, Duration{});
      break;
    case FaultKind::kMute:
      condition.mute = true;
      break;
    case FaultKind::kBrownOut:
      Happened(EventKind::kBrownOut, index, 0);
      StartAnew(fault.servo, kBrownOutTakes);
      break;
    case FaultKind::kJam:
      model.Jam(ToRad(fault.value));
      break;
    case FaultKind::kHot:
      model.Heat(fault.value);
      break;
    case FaultKind::kJump:
      model.SetSensorError(fault.value / own_per_rad_);
      break;
  }
}

void Bus::End(const Fault& fault) {
  Happened(EventKind::kFaultEnds, static_cast<int>(fault.servo), static_cast<int>(fault.kind));
  if (fault.kind == FaultKind::kVanish) {
    conditions_[fault.servo].powered = true;
    StartAnew(fault.servo, kBrownOutTakes);
  }
  if (fault.kind == FaultKind::kMute) conditions_[fault.servo].mute = false;
  if (fault.kind == FaultKind::kJam) models_[fault.servo].Unjam();
  if (fault.kind == FaultKind::kJump) models_[fault.servo].SetSensorError(0);
}

}  // namespace facewire::sim
