#include "tests/sim/dynamixel_servo.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace facewire::sim {

using dynamixel::Code;

namespace {

constexpr double kCountsPerRad = 4096 / (2 * std::numbers::pi);
constexpr double kCentre = 2048;
constexpr double kVelocityUnit = 0.229 * kRpm;
// Profile acceleration's unit is 214.577 rev/min^2.
constexpr double kAccelerationUnit = 214.577 / 60 * kRpm;
// Assumed (README.md): persistent load means this share of the stall current for this long.
constexpr double kOverloadShare = 0.8;
constexpr int kOverloadMs = 1500;
constexpr int kVoltageMs = 100;

enum Mode : std::int32_t {
  kCurrent = 0,
  kVelocity = 1,
  kPosition = 3,
  kExtended = 4,
  kCurrentPosition = 5,
  kPwm = 16
};
constexpr unsigned kReverseBit = 0, kTimeProfileBit = 2;

bool IsGoal(std::uint16_t address) {
  return address == dynamixel::kGoalPwm || address == dynamixel::kGoalCurrent ||
         address == dynamixel::kGoalVelocity || address == dynamixel::kGoalPosition;
}

}  // namespace

double DynamixelServo::baud() const {
  constexpr std::array<double, 8> kRates = {9600,      57600,     115200,    1'000'000,
                                            2'000'000, 3'000'000, 4'000'000, 4'500'000};
  return kRates[static_cast<std::size_t>(table_.Get(dynamixel::kBaudRate)) % kRates.size()];
}

bool DynamixelServo::HasDriveMode(unsigned bit) const {
  return (static_cast<unsigned>(table_.Get(dynamixel::kDriveMode)) >> bit & 1U) != 0;
}

double DynamixelServo::ToCounts(double rad) const {
  const bool reverse = HasDriveMode(kReverseBit);
  return kCentre + (reverse ? -rad : rad) * kCountsPerRad + table_.Get(dynamixel::kHomingOffset);
}

double DynamixelServo::ToRad(double counts) const {
  const bool reverse = HasDriveMode(kReverseBit);
  const double rad = (counts - table_.Get(dynamixel::kHomingOffset) - kCentre) / kCountsPerRad;
  return reverse ? -rad : rad;
}

bool DynamixelServo::PositionMode() const {
  const std::int32_t mode = table_.Get(dynamixel::kOperatingMode);
  return mode == kPosition || mode == kExtended || mode == kCurrentPosition;
}

void DynamixelServo::Start() {
  table_.ResetRam();
  registered_.reset();
  tripped_ = false;
  overload_ms_ = voltage_ms_ = silence_ms_ = 0;
  tick_ms_ = 0;
  motor_->Release();
  Measure(0);
  table_.Set(dynamixel::kGoalPosition, table_.Get(dynamixel::kPresentPosition));
}

std::uint8_t DynamixelServo::Status(Code code) const {
  const bool alert = table_.Get(dynamixel::kHardwareError) != 0;
  return static_cast<std::uint8_t>(static_cast<unsigned>(code) | (alert ? 0x80U : 0U));
}

// The limits that are themselves in the table.
Code DynamixelServo::CheckGoals(const DynamixelItem& item, std::int32_t value) const {
  const auto beyond = [&](std::uint16_t limit) { return std::abs(value) > table_.Get(limit); };
  if (IsGoal(item.address) && tripped_) return Code::kRange;
  if (item.address == dynamixel::kBusWatchdog && tripped_ && value != 0) return Code::kRange;
  if (item.address == dynamixel::kGoalPwm && beyond(dynamixel::kPwmLimit)) return Code::kLimit;
  if (item.address == dynamixel::kGoalVelocity && beyond(dynamixel::kVelocityLimit)) {
    return Code::kLimit;
  }
  if (item.address == dynamixel::kGoalCurrent && beyond(dynamixel::kCurrentLimit)) {
    return Code::kLimit;
  }
  if (item.address == dynamixel::kGoalPosition &&
      table_.Get(dynamixel::kOperatingMode) == kPosition &&
      (value < table_.Get(dynamixel::kMinPosition) ||
       value > table_.Get(dynamixel::kMaxPosition))) {
    report_(EventKind::kOutsideLimits, value);
    return Code::kLimit;
  }
  return Code::kNone;
}

Code DynamixelServo::Write(std::uint16_t address, std::span<const std::uint8_t> bytes) {
  Code code = Code::kNone;
  const auto check = [&](const DynamixelItem& item, std::int32_t value) {
    if (code == Code::kNone) code = CheckGoals(item, value);
  };
  const Code shape = table_.ForEachItem(address, bytes, torque(), check);
  if (address < dynamixel::kFirstOfRam && shape == Code::kAccess && torque()) {
    report_(EventKind::kEepromTry, address);
  }
  if (shape != Code::kNone) return shape;
  if (code != Code::kNone) return code;
  table_.ForEachItem(address, bytes, torque(), [&](const DynamixelItem& item, std::int32_t value) {
    WriteItem(item, value);
  });
  return Code::kNone;
}

void DynamixelServo::WriteItem(const DynamixelItem& item, std::int32_t value) {
  if (item.address < dynamixel::kFirstOfRam) report_(EventKind::kEepromWrite, item.address);
  if (item.address == dynamixel::kTorqueEnable) {
    SetTorque(value != 0);
    return;
  }
  if (item.address == dynamixel::kBusWatchdog) {
    tripped_ = false;
    silence_ms_ = 0;
  }
  if (item.address == dynamixel::kGoalPosition) PlanTimedProfile(value);
  table_.Set(item.address, value);
}

// With the profile set by times, Profile Velocity is how long the whole way takes, and Profile
// Acceleration how long its start and its end take, in ms.
void DynamixelServo::PlanTimedProfile(double goal) {
  const double whole = table_.Get(dynamixel::kProfileVelocity);
  const double part = std::min<double>(table_.Get(dynamixel::kProfileAcceleration), whole / 2);
  profile_speed_ = whole > 0 ? std::abs(goal - trajectory_.position) / (whole - part) : 0;
  profile_acceleration_ = part > 0 ? profile_speed_ / part : 0;
}

void DynamixelServo::SetTorque(bool on) {
  const unsigned errors = static_cast<unsigned>(table_.Get(dynamixel::kHardwareError));
  if (on && (errors & static_cast<unsigned>(table_.Get(dynamixel::kShutdown))) != 0) return;
  if (on == torque()) return;
  table_.Set(dynamixel::kTorqueEnable, on ? 1 : 0);
  if (!on) {
    motor_->Release();
    return;
  }
  const double here = std::round(ToCounts(motor_->sensed_rad()));
  trajectory_.Jump(here);
  if (holds_) {
    table_.Set(dynamixel::kGoalPosition, static_cast<std::int32_t>(here));
    table_.Set(dynamixel::kGoalVelocity, 0);
  }
  silence_ms_ = 0;
}

Code DynamixelServo::RegisterWrite(std::uint16_t address, std::span<const std::uint8_t> bytes) {
  const Code shape =
      table_.ForEachItem(address, bytes, torque(), [](const DynamixelItem&, std::int32_t) {});
  if (shape != Code::kNone) return shape;
  registered_ = {address, {bytes.begin(), bytes.end()}};
  table_.Set(dynamixel::kRegistered, 1);
  return Code::kNone;
}

Code DynamixelServo::Action() {
  if (!registered_) return Code::kInstruction;
  const Registered write = *registered_;
  registered_.reset();
  table_.Set(dynamixel::kRegistered, 0);
  return Write(write.address, write.bytes);
}

void DynamixelServo::FactoryReset(std::uint8_t option) {
  const std::int32_t id = table_.Get(dynamixel::kId);
  const std::int32_t baud = table_.Get(dynamixel::kBaudRate);
  table_.Reset();
  if (option == 0x01 || option == 0x02) table_.Set(dynamixel::kId, id);
  if (option == 0x02) table_.Set(dynamixel::kBaudRate, baud);
}

Code DynamixelServo::ClearTurns() const {
  return table_.Get(dynamixel::kMoving) != 0 ? Code::kFail : Code::kNone;
}

void DynamixelServo::Millisecond(double supply_V) {
  tick_ms_ = (tick_ms_ + 1) % 32768;
  if (!torque()) trajectory_.Jump(ToCounts(motor_->sensed_rad()));
  Protect(supply_V);
  WatchSilence();
  if (torque()) Drive();
}

void DynamixelServo::WatchSilence() {
  const std::int32_t limit = table_.Get(dynamixel::kBusWatchdog);
  if (!torque() || limit < 1 || limit > 127) return;
  if (++silence_ms_ <= limit * 20) return;
  tripped_ = true;
  table_.Set(dynamixel::kBusWatchdog, 0xFF);
  report_(EventKind::kWatchdog, limit * 20);
  // It stops at once, without its profile, and stays where it then is.
  const double here = std::round(ToCounts(motor_->sensed_rad()));
  trajectory_.Jump(here);
  speed_goal_ = 0;
  if (table_.Get(dynamixel::kOperatingMode) == kCurrent) motor_->Push(0);
}

void DynamixelServo::Fail(unsigned bit, EventKind kind, int detail) {
  const unsigned errors = static_cast<unsigned>(table_.Get(dynamixel::kHardwareError));
  if ((errors >> bit & 1U) != 0) return;
  table_.Set(dynamixel::kHardwareError, static_cast<std::int32_t>(errors | 1U << bit));
  report_(kind, detail);
  report_(EventKind::kError, static_cast<int>(errors | 1U << bit));
  if ((static_cast<unsigned>(table_.Get(dynamixel::kShutdown)) >> bit & 1U) != 0) SetTorque(false);
}

void DynamixelServo::Protect(double supply_V) {
  const double tenths = supply_V * 10;
  const bool bad = tenths > table_.Get(dynamixel::kMaxVoltage) + 0.5 ||
                   tenths < table_.Get(dynamixel::kMinVoltage) - 0.5;
  voltage_ms_ = bad ? voltage_ms_ + 1 : 0;
  if (voltage_ms_ > kVoltageMs) {
    Fail(dynamixel::kVoltageBit, EventKind::kVoltage, static_cast<int>(tenths));
  }
  if (motor_->temperature_C() > table_.Get(dynamixel::kTemperatureLimit)) {
    Fail(dynamixel::kHeatBit, EventKind::kOverheated, static_cast<int>(motor_->temperature_C()));
  }
  const double share = std::abs(motor_->current_A()) / motor_->parameters().stall_current_A;
  overload_ms_ = share > kOverloadShare ? overload_ms_ + 1 : 0;
  if (overload_ms_ > kOverloadMs) Fail(dynamixel::kOverloadBit, EventKind::kOverload, 0);
}

void DynamixelServo::Drive() {
  const std::int32_t mode = table_.Get(dynamixel::kOperatingMode);
  motor_->LimitDuty(table_.Get(dynamixel::kPwmLimit) / 885.0);
  double most_A = std::numeric_limits<double>::infinity();
  if (model_->measures_current) {
    most_A = table_.Get(dynamixel::kCurrentLimit) / 1000.0;
    if (mode == kCurrentPosition) {
      most_A = std::min(most_A, std::abs(table_.Get(dynamixel::kGoalCurrent)) / 1000.0);
    }
  }
  motor_->LimitCurrent(most_A);
  if (PositionMode()) {
    double speed = profile_speed_;
    double acceleration = profile_acceleration_;
    if (!HasDriveMode(kTimeProfileBit)) {
      speed = table_.Get(dynamixel::kProfileVelocity) * kVelocityUnit * kCountsPerRad / 1e3;
      acceleration =
          table_.Get(dynamixel::kProfileAcceleration) * kAccelerationUnit * kCountsPerRad / 1e6;
    }
    if (speed == 0) acceleration = 0;  // a step: without a velocity there is no profile
    if (!tripped_) trajectory_.Step(table_.Get(dynamixel::kGoalPosition), speed, acceleration);
    motor_->GoTo(ToRad(trajectory_.position));
  } else if (mode == kVelocity) {
    if (!tripped_) speed_goal_ = table_.Get(dynamixel::kGoalVelocity) * kVelocityUnit;
    const bool reverse = HasDriveMode(kReverseBit);
    motor_->Turn(reverse ? -speed_goal_ : speed_goal_);
    trajectory_.Jump(ToCounts(motor_->sensed_rad()));
  } else if (mode == kPwm) {
    motor_->Push(tripped_ ? 0 : table_.Get(dynamixel::kGoalPwm) / 885.0);
  } else if (mode == kCurrent) {
    const std::int32_t goal = tripped_ ? 0 : table_.Get(dynamixel::kGoalCurrent);
    motor_->LimitCurrent(std::abs(goal) / 1000.0);
    motor_->Push(goal == 0 ? 0 : std::copysign(1.0, goal));
  }
}

// What the table shows of the servo, a millisecond old at most.
void DynamixelServo::Measure(double supply_V) {
  const bool reverse = HasDriveMode(kReverseBit);
  const double sign = reverse ? -1 : 1;
  const auto set = [&](std::uint16_t address, double value) {
    table_.Set(address, static_cast<std::int32_t>(std::lround(value)));
  };
  const double speed = sign * motor_->speed_radps() / kVelocityUnit;
  const double share = sign * motor_->current_A() / motor_->parameters().stall_current_A;
  set(dynamixel::kRealtimeTick, tick_ms_);
  set(dynamixel::kMoving, std::abs(speed) > table_.Get(dynamixel::kMovingThreshold) ? 1 : 0);
  set(dynamixel::kPresentPwm, sign * motor_->duty() * 885);
  set(dynamixel::kPresentCurrent,
      model_->measures_current ? sign * motor_->current_A() * 1000 : share * 1000);
  set(dynamixel::kPresentVelocity, speed);
  set(dynamixel::kPresentPosition, ToCounts(motor_->sensed_rad()));
  set(dynamixel::kVelocityTrajectory, trajectory_.speed * 1000 / kCountsPerRad / kVelocityUnit);
  set(dynamixel::kPositionTrajectory, trajectory_.position);
  set(dynamixel::kPresentVoltage, supply_V * 10);
  set(dynamixel::kPresentTemperature, motor_->temperature_C());
}

}  // namespace facewire::sim
