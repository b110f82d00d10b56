#ifndef FACEWIRE_TESTS_SIM_FEETECH_SERVO_H_
#define FACEWIRE_TESTS_SIM_FEETECH_SERVO_H_

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "tests/sim/approach.h"
#include "tests/sim/servo_model.h"
#include "tests/sim/trace.h"

namespace facewire::sim {

// Addresses of Feetech's memory tables that both series share.
namespace feetech {
constexpr std::uint8_t kEndian = 2, kModel = 3, kId = 5, kBaudRate = 6, kReturnDelay = 7,
                       kResponseLevel = 8, kMinAngle = 9, kMaxAngle = 11, kMaxTemperature = 13,
                       kMaxVoltage = 14, kMinVoltage = 15, kMaxTorque = 16, kPhase = 18,
                       kUnload = 19, kForwardDeadBand = 26, kProtectionCurrent = 28, kOffset = 31,
                       kOvercurrentTime = 38, kTorque = 40, kAcceleration = 41, kGoal = 42,
                       kTime = 44, kSpeed = 46, kTorqueLimit = 48, kPosition = 56,
                       kPresentSpeed = 58, kLoad = 60, kVoltage = 62, kTemperature = 63,
                       kRegistered = 64, kStatus = 65, kMoving = 66, kCurrent = 69;
constexpr std::uint8_t kFirstOfEeprom = 5, kFirstOfRam = 40;
// Bits of the status, of Unload and of the error byte of a reply.
constexpr unsigned kVoltageBit = 0, kHeatBit = 2, kCurrentBit = 3, kLoadBit = 5;
// Bits of Phase: the unit of speeds (1: count/s, 0: 50 counts/s; STS only), and what speed 0 means
// (1: as fast as it can, 0: stop).
constexpr unsigned kFineSpeedBit = 2, kZeroIsFastBit = 3;
}  // namespace feetech

// Where the two series differ.
struct FeetechSeries {
  ServoParameters servo;
  double supply_V;
  bool big_endian;
  int counts;  // of `turn_rad`
  double turn_rad;
  bool magnetic;  // STS: has acceleration, offset, torque limit, current
  std::uint8_t lock, protective_torque, protection_time, overload_torque;  // addresses
};
const FeetechSeries& Sts();  // little-endian, STS3215 at 7.4 V
const FeetechSeries& Scs();  // big-endian, SC09 at 6 V

// The electronics of one Feetech bus servo. Packets are feetech.h's business.
class FeetechServo {
 public:
  using Report = std::function<void(EventKind, int detail)>;
  static constexpr std::size_t kSize = 87;

  FeetechServo(const FeetechSeries& series, std::uint8_t id, double baud, ServoModel& motor,
               Report report);

  // Takes what was written while unlocked; the RAM as from the works.
  void Start();
  // Bytes as they are on the wire; beyond the table there are zeros.
  void Read(std::uint8_t address, std::span<std::uint8_t> bytes, double supply_V);
  void Write(std::uint8_t address, std::span<const std::uint8_t> bytes);
  void RegisterWrite(std::uint8_t address, std::span<const std::uint8_t> bytes);
  void Action();
  void FactoryReset();
  void Millisecond(double supply_V);

  int Byte(std::uint8_t address) const { return memory_[address]; }
  int Word(std::uint8_t address) const;  // as it is, sign bit and all
  void SetByte(std::uint8_t address, int value);
  void SetWord(std::uint8_t address, int value);
  std::uint8_t id() const { return memory_[feetech::kId]; }
  double baud() const;  // 0: an entry that means none
  std::uint8_t status() const { return memory_[feetech::kStatus]; }
  double goal() const { return goal_; }  // within the servo's limits
  double commanded() const { return path_.position; }

 private:
  void OnWritten(std::uint8_t address);
  void OnGoal();
  void SetTorque(int value);
  void CentreHere();
  void Protect(double supply_V);
  void Raise(unsigned bit, EventKind kind, int detail);
  void SetStatus(unsigned bit, bool on);
  void Measure(double supply_V);
  double ToCounts(double rad) const;
  double ToRad(double counts) const;
  bool HasPhase(unsigned bit) const { return (memory_[feetech::kPhase] >> bit & 1) != 0; }
  double SpeedUnit() const;  // counts/s
  void FollowPath();
  bool Unloads(unsigned bit) const { return (memory_[feetech::kUnload] >> bit & 1) != 0; }

  const FeetechSeries* series_;
  ServoModel* motor_;
  Report report_;
  std::array<std::uint8_t, kSize> memory_{};
  std::array<std::uint8_t, feetech::kFirstOfRam> permanent_{};
  Approach path_;  // counts, per millisecond
  double goal_ = 0;
  struct Registered {
    std::uint8_t address;
    std::vector<std::uint8_t> bytes;
  };
  std::optional<Registered> registered_;
  int overload_ms_ = 0, overcurrent_ms_ = 0;
  bool overloaded_ = false;
};

}  // namespace facewire::sim

#endif  // FACEWIRE_TESTS_SIM_FEETECH_SERVO_H_
