#ifndef FACEWIRE_TESTS_SIM_DYNAMIXEL_SERVO_H_
#define FACEWIRE_TESTS_SIM_DYNAMIXEL_SERVO_H_

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "tests/sim/approach.h"
#include "tests/sim/dynamixel_table.h"
#include "tests/sim/servo_model.h"
#include "tests/sim/trace.h"

namespace facewire::sim {

// The electronics of one X-series servo: its table and what the entries do. Its packets are
// dynamixel.h's business.
class DynamixelServo {
 public:
  using Report = std::function<void(EventKind, int detail)>;

  // With `holds`, torque on makes the present position the goal; otherwise it goes to the goal that
  // is in its table.
  DynamixelServo(const DynamixelModel& model, bool holds, ServoModel& motor, Report report)
      : model_(&model), holds_(holds), motor_(&motor), table_(model), report_(std::move(report)) {}

  const DynamixelTable& table() const { return table_; }
  DynamixelTable& table() { return table_; }
  bool torque() const { return table_.Get(dynamixel::kTorqueEnable) != 0; }
  std::uint8_t id() const { return static_cast<std::uint8_t>(table_.Get(dynamixel::kId)); }
  double baud() const;
  // The commanded position right now, in counts.
  double trajectory() const { return trajectory_.position; }

  // Power is (again) there.
  void Start();
  // Any instruction packet on the bus, whoever it is for.
  void FeedWatchdog() { silence_ms_ = 0; }
  dynamixel::Code Write(std::uint16_t address, std::span<const std::uint8_t> bytes);
  dynamixel::Code RegisterWrite(std::uint16_t address, std::span<const std::uint8_t> bytes);
  dynamixel::Code Action();
  void FactoryReset(std::uint8_t option);
  dynamixel::Code ClearTurns() const;
  // The error byte of a status: alert in bit 7.
  std::uint8_t Status(dynamixel::Code code) const;

  void Millisecond(double supply_V);
  // Brings the entries up to date that show what the servo does.
  void Measure(double supply_V);

 private:
  dynamixel::Code CheckGoals(const DynamixelItem& item, std::int32_t value) const;
  void WriteItem(const DynamixelItem& item, std::int32_t value);
  void SetTorque(bool on);
  void WatchSilence();
  void Protect(double supply_V);
  void Fail(unsigned bit, EventKind kind, int detail);
  void Drive();
  void PlanTimedProfile(double goal);
  bool HasDriveMode(unsigned bit) const;
  double ToRad(double counts) const;
  double ToCounts(double rad) const;
  bool PositionMode() const;

  const DynamixelModel* model_;
  bool holds_;
  ServoModel* motor_;
  DynamixelTable table_;
  Report report_;
  Approach trajectory_;                                  // counts, per millisecond
  double profile_speed_ = 0, profile_acceleration_ = 0;  // of a profile set by times
  double speed_goal_ = 0;
  struct Registered {
    std::uint16_t address;
    std::vector<std::uint8_t> bytes;
  };
  std::optional<Registered> registered_;
  int silence_ms_ = 0;
  bool tripped_ = false;
  int overload_ms_ = 0;
  int voltage_ms_ = 0;
  unsigned tick_ms_ = 0;
};

}  // namespace facewire::sim

#endif  // FACEWIRE_TESTS_SIM_DYNAMIXEL_SERVO_H_
