#include "tests/sim/feetech_servo.h"

#include <algorithm>
#include <cmath>

namespace facewire::sim {
namespace {

constexpr std::array<double, 8> kRates = {1'000'000, 500'000, 250'000, 128'000,
                                          115'200,   76'800,  57'600,  38'400};
constexpr unsigned kSign15 = 0x8000;
constexpr unsigned kSign11 = 0x0800;  // of the offset
constexpr unsigned kSign10 = 0x0400;
constexpr double kCurrentUnit = 0.0065;
constexpr double kAccelerationUnit = 100;  // counts per second and second
constexpr int kCentreCode = 128;           // written to the torque switch

// Sign and magnitude, the way Feetech writes negative numbers.
int Signed(int raw, unsigned sign) {
  const auto bits = static_cast<unsigned>(raw);
  const int magnitude = static_cast<int>(bits & (sign - 1));
  return (bits & sign) != 0 ? -magnitude : magnitude;
}

int Raw(double value, unsigned sign) {
  const auto most = static_cast<double>(sign - 1);
  const auto magnitude = static_cast<int>(std::lround(std::min(std::abs(value), most)));
  return value < 0 && magnitude != 0 ? magnitude | static_cast<int>(sign) : magnitude;
}

bool IsReadOnly(std::uint8_t address) {
  return address < feetech::kFirstOfEeprom || address >= feetech::kPosition;
}

}  // namespace

const FeetechSeries& Sts() {
  static const FeetechSeries series{Sts3215(), 7.4, false, 4096, 360 * kDegree,
                                    true,      55,  34,    35,   36};
  return series;
}

const FeetechSeries& Scs() {
  static const FeetechSeries series{Sc09(), 6.0, true, 1024, 300 * kDegree, false, 48, 37, 38, 39};
  return series;
}

FeetechServo::FeetechServo(const FeetechSeries& series, std::uint8_t id, double baud,
                           ServoModel& motor, Report report)
    : series_(&series), motor_(&motor), report_(std::move(report)) {
  FactoryReset();
  permanent_[feetech::kId] = id;
  const auto rate = std::find(kRates.begin(), kRates.end(), baud);
  permanent_[feetech::kBaudRate] = static_cast<std::uint8_t>(rate - kRates.begin());
  Start();
}

double FeetechServo::baud() const {
  const std::size_t rate = memory_[feetech::kBaudRate];
  return rate < kRates.size() ? kRates[rate] : 0;
}

int FeetechServo::Word(std::uint8_t address) const {
  const int first = memory_[address];
  const int second = memory_[address + 1U];
  return series_->big_endian ? first << 8 | second : second << 8 | first;
}

void FeetechServo::SetByte(std::uint8_t address, int value) {
  memory_[address] = static_cast<std::uint8_t>(value);
}

void FeetechServo::SetWord(std::uint8_t address, int value) {
  const auto low = static_cast<std::uint8_t>(value & 0xFF);
  const auto high = static_cast<std::uint8_t>(value >> 8 & 0xFF);
  memory_[address] = series_->big_endian ? high : low;
  memory_[address + 1U] = series_->big_endian ? low : high;
}

// As from the works; the id stays.
void FeetechServo::FactoryReset() {
  const std::uint8_t id = permanent_[feetech::kId];
  memory_.fill(0);
  SetByte(feetech::kEndian, series_->big_endian ? 1 : 0);
  SetByte(feetech::kModel, series_->magnetic ? 9 : 5);
  SetByte(4, series_->magnetic ? 3 : 4);
  SetByte(feetech::kId, id);
  SetByte(feetech::kResponseLevel, 1);
  SetWord(feetech::kMinAngle, series_->magnetic ? 0 : 20);
  SetWord(feetech::kMaxAngle, series_->magnetic ? 4095 : 1003);
  SetByte(feetech::kMaxTemperature, 70);
  SetByte(feetech::kMaxVoltage, series_->magnetic ? 80 : 84);
  SetByte(feetech::kMinVoltage, 40);
  SetWord(feetech::kMaxTorque, 1000);
  SetByte(feetech::kPhase, 12);
  SetByte(feetech::kUnload, series_->magnetic ? 44 : 37);
  SetByte(feetech::kForwardDeadBand, 1);
  SetByte(feetech::kForwardDeadBand + 1, 1);
  if (series_->magnetic) {
    SetWord(feetech::kProtectionCurrent, 500);
    SetByte(feetech::kOvercurrentTime, 200);
  }
  SetByte(series_->protective_torque, 20);
  SetByte(series_->protection_time, 200);
  SetByte(series_->overload_torque, 80);
  std::copy_n(memory_.begin(), permanent_.size(), permanent_.begin());
}

void FeetechServo::Start() {
  memory_.fill(0);
  std::copy(permanent_.begin(), permanent_.end(), memory_.begin());
  if (series_->magnetic) SetWord(feetech::kTorqueLimit, Word(feetech::kMaxTorque));
  SetByte(series_->lock, 1);
  registered_.reset();
  overloaded_ = false;
  overload_ms_ = overcurrent_ms_ = 0;
  motor_->Release();
  path_.Jump(ToCounts(motor_->sensed_rad()));
  goal_ = path_.position;
}

double FeetechServo::ToCounts(double rad) const {
  const int offset = series_->magnetic ? Signed(Word(feetech::kOffset), kSign11) : 0;
  return series_->counts / 2.0 + rad * series_->counts / series_->turn_rad - offset;
}

double FeetechServo::ToRad(double counts) const {
  const int offset = series_->magnetic ? Signed(Word(feetech::kOffset), kSign11) : 0;
  return (counts + offset - series_->counts / 2.0) * series_->turn_rad / series_->counts;
}

void FeetechServo::Read(std::uint8_t address, std::span<std::uint8_t> bytes, double supply_V) {
  Measure(supply_V);
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    bytes[i] = address + i < kSize ? memory_[address + i] : 0;
  }
}

void FeetechServo::Write(std::uint8_t address, std::span<const std::uint8_t> bytes) {
  bool goal = false;
  for (std::size_t i = 0; i < bytes.size() && address + i < kSize; ++i) {
    const auto at = static_cast<std::uint8_t>(address + i);
    if (IsReadOnly(at)) continue;
    const bool unlocked = memory_[series_->lock] == 0;
    memory_[at] = bytes[i];
    if (at < feetech::kFirstOfRam) {
      // Locked, it takes the value until the power goes.
      if (unlocked) permanent_[at] = bytes[i];
      report_(unlocked ? EventKind::kEepromWrite : EventKind::kEepromTry, at);
    }
    if (at == feetech::kTorque) SetTorque(bytes[i]);
    if (at == feetech::kGoal || at == feetech::kGoal + 1) goal = true;
  }
  if (goal) OnGoal();
}

void FeetechServo::OnGoal() {
  // A goal switches a released motor on, and ends what the overload protection did.
  if (memory_[feetech::kTorque] == 0) SetTorque(1);
  overloaded_ = false;
  overload_ms_ = 0;
  SetStatus(feetech::kLoadBit, false);
  const int low = Word(feetech::kMinAngle);
  const int high = Word(feetech::kMaxAngle);
  goal_ = series_->magnetic ? Signed(Word(feetech::kGoal), kSign15) : Word(feetech::kGoal);
  if (high > low && (goal_ < low || goal_ > high)) {
    report_(EventKind::kOutsideLimits, static_cast<int>(goal_));
    goal_ = std::clamp<double>(goal_, low, high);
  }
}

void FeetechServo::SetTorque(int value) {
  if (value == kCentreCode && series_->magnetic) {
    CentreHere();
    value = 1;
  }
  SetByte(feetech::kTorque, value);
  if (value != 1) {
    motor_->Release();
    if (value == 2) motor_->Brake();
  } else if (!motor_->driven()) {
    path_.Jump(ToCounts(motor_->sensed_rad()));
    goal_ = path_.position;
    motor_->GoTo(ToRad(goal_));
  }
}

// The position it is at becomes the middle, for good.
void FeetechServo::CentreHere() {
  SetWord(feetech::kOffset, 0);
  SetWord(feetech::kOffset, Raw(ToCounts(motor_->sensed_rad()) - series_->counts / 2.0, kSign11));
  std::copy_n(memory_.begin() + feetech::kOffset, 2, permanent_.begin() + feetech::kOffset);
  report_(EventKind::kEepromWrite, feetech::kOffset);
  path_.Jump(ToCounts(motor_->sensed_rad()));
  goal_ = path_.position;
}

void FeetechServo::RegisterWrite(std::uint8_t address, std::span<const std::uint8_t> bytes) {
  registered_ = {address, {bytes.begin(), bytes.end()}};
  SetByte(feetech::kRegistered, 1);
}

void FeetechServo::Action() {
  if (!registered_) return;
  const Registered write = *registered_;
  registered_.reset();
  SetByte(feetech::kRegistered, 0);
  Write(write.address, write.bytes);
}

void FeetechServo::SetStatus(unsigned bit, bool on) {
  const unsigned status = memory_[feetech::kStatus];
  SetByte(feetech::kStatus, static_cast<int>(on ? status | 1U << bit : status & ~(1U << bit)));
}

void FeetechServo::Raise(unsigned bit, EventKind kind, int detail) {
  if ((memory_[feetech::kStatus] >> bit & 1) == 0) {
    SetStatus(bit, true);
    report_(kind, detail);
    report_(EventKind::kError, memory_[feetech::kStatus]);
  }
  if (bit != feetech::kLoadBit && Unloads(bit) && motor_->driven()) SetTorque(0);
}

void FeetechServo::Protect(double supply_V) {
  const double tenths = supply_V * 10;
  if (tenths > Byte(feetech::kMaxVoltage) + 0.5 || tenths < Byte(feetech::kMinVoltage) - 0.5) {
    Raise(feetech::kVoltageBit, EventKind::kVoltage, static_cast<int>(tenths));
  } else {
    SetStatus(feetech::kVoltageBit, false);
  }
  if (motor_->temperature_C() > Byte(feetech::kMaxTemperature)) {
    Raise(feetech::kHeatBit, EventKind::kOverheated, static_cast<int>(motor_->temperature_C()));
  } else {
    SetStatus(feetech::kHeatBit, false);
  }
  const double current_A = std::abs(motor_->current_A());
  const double most_A = Word(feetech::kProtectionCurrent) * kCurrentUnit;
  overcurrent_ms_ = series_->magnetic && most_A > 0 && current_A > most_A ? overcurrent_ms_ + 1 : 0;
  if (series_->magnetic && overcurrent_ms_ > Byte(feetech::kOvercurrentTime) * 10) {
    Raise(feetech::kCurrentBit, EventKind::kOvercurrent, static_cast<int>(current_A * 1000));
  } else if (current_A <= most_A) {
    SetStatus(feetech::kCurrentBit, false);
  }
  const double load = std::abs(motor_->duty());
  overload_ms_ = load * 100 > Byte(series_->overload_torque) ? overload_ms_ + 1 : 0;
  if (overload_ms_ > Byte(series_->protection_time) * 10 && Unloads(feetech::kLoadBit)) {
    overloaded_ = true;
    Raise(feetech::kLoadBit, EventKind::kOverload, 0);
  }
}

void FeetechServo::Millisecond(double supply_V) {
  Protect(supply_V);
  if (memory_[feetech::kTorque] != 1) {
    path_.Jump(ToCounts(motor_->sensed_rad()));
    return;
  }
  double limit =
      (series_->magnetic ? Word(feetech::kTorqueLimit) : Word(feetech::kMaxTorque)) / 1000.0;
  if (overloaded_) limit = std::min(limit, Byte(series_->protective_torque) / 100.0);
  motor_->LimitDuty(std::min(1.0, limit));
  FollowPath();
  motor_->GoTo(ToRad(path_.position));
}

double FeetechServo::SpeedUnit() const {
  return series_->magnetic && !HasPhase(feetech::kFineSpeedBit) ? 50 : 1;
}

void FeetechServo::FollowPath() {
  double speed = Word(feetech::kSpeed) * SpeedUnit() / 1000.0;
  const int time_ms = series_->magnetic ? 0 : Word(feetech::kTime);
  if (speed == 0 && time_ms > 0 && !path_.At(goal_)) {
    // The way takes this long, from where it was when the goal came.
    speed = std::max(std::abs(path_.speed), std::abs(goal_ - path_.position) / time_ms);
  } else if (speed == 0 && !HasPhase(feetech::kZeroIsFastBit)) {
    path_.Jump(path_.position);
    return;
  }
  const double acceleration =
      series_->magnetic ? Byte(feetech::kAcceleration) * kAccelerationUnit / 1e6 : 0;
  path_.Step(goal_, speed, acceleration);
}

void FeetechServo::Measure(double supply_V) {
  const double counts_per_rad = series_->counts / series_->turn_rad;
  const double position = std::round(ToCounts(motor_->sensed_rad()));
  const double speed = motor_->speed_radps() * counts_per_rad;
  SetWord(feetech::kPosition, series_->magnetic
                                  ? Raw(position, kSign15)
                                  : static_cast<int>(std::clamp(position, 0.0, 1023.0)));
  SetWord(feetech::kPresentSpeed, Raw(speed / SpeedUnit(), kSign15));
  SetWord(feetech::kLoad, Raw(motor_->duty() * 1000, kSign10));
  SetByte(feetech::kVoltage, static_cast<int>(std::lround(supply_V * 10)));
  SetByte(feetech::kTemperature, static_cast<int>(std::lround(motor_->temperature_C())));
  SetByte(feetech::kMoving, std::abs(speed) > series_->counts / 400.0 ? 1 : 0);
  SetWord(67, static_cast<int>(goal_));
  if (series_->magnetic)
    SetWord(feetech::kCurrent, Raw(motor_->current_A() / kCurrentUnit, kSign15));
}

}  // namespace facewire::sim
