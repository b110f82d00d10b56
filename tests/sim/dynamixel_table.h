#ifndef FACEWIRE_TESTS_SIM_DYNAMIXEL_TABLE_H_
#define FACEWIRE_TESTS_SIM_DYNAMIXEL_TABLE_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "tests/sim/servo_parameters.h"

namespace facewire::sim {

// Addresses of the X series' control table that the simulation acts on.
namespace dynamixel {
constexpr std::uint16_t kModelNumber = 0, kFirmware = 6, kId = 7, kBaudRate = 8, kReturnDelay = 9,
                        kDriveMode = 10, kOperatingMode = 11, kHomingOffset = 20,
                        kMovingThreshold = 24, kTemperatureLimit = 31, kMaxVoltage = 32,
                        kMinVoltage = 34, kPwmLimit = 36, kCurrentLimit = 38, kVelocityLimit = 44,
                        kMaxPosition = 48, kMinPosition = 52, kShutdown = 63, kTorqueEnable = 64,
                        kStatusReturnLevel = 68, kRegistered = 69, kHardwareError = 70,
                        kBusWatchdog = 98, kGoalPwm = 100, kGoalCurrent = 102, kGoalVelocity = 104,
                        kProfileAcceleration = 108, kProfileVelocity = 112, kGoalPosition = 116,
                        kRealtimeTick = 120, kMoving = 122, kPresentPwm = 124,
                        kPresentCurrent = 126,  // Present Load on models without a current sensor
    kPresentVelocity = 128, kPresentPosition = 132, kVelocityTrajectory = 136,
                        kPositionTrajectory = 140, kPresentVoltage = 144, kPresentTemperature = 146;
constexpr std::uint16_t kFirstOfRam = 64;

// The error number of a status packet, its bits 0 to 6.
enum class Code : std::uint8_t {
  kNone = 0,
  kFail = 1,
  kInstruction = 2,
  kCrc = 3,
  kRange = 4,
  kLength = 5,
  kLimit = 6,
  kAccess = 7
};
// Bits of Hardware Error Status and of Shutdown.
constexpr unsigned kVoltageBit = 0, kHeatBit = 2, kShockBit = 4, kOverloadBit = 5;
}  // namespace dynamixel

struct DynamixelItem {
  std::uint16_t address;
  std::uint8_t size;
  bool writable;
  std::int32_t initial;
  std::int32_t low, high;  // what may be written
};

// One model of the X series.
struct DynamixelModel {
  ServoParameters servo;
  double supply_V;
  bool measures_current;                 // otherwise address 126 is a load in tenths of a percent
  std::span<const DynamixelItem> items;  // in the order of addresses
};
const DynamixelModel& Xl330();
const DynamixelModel& Xl430();

// The memory of one servo, and what its manual allows to do with it.
class DynamixelTable {
 public:
  explicit DynamixelTable(const DynamixelModel& model);

  // Everything as from the works, and the RAM alone.
  void Reset();
  void ResetRam();

  std::int32_t Get(std::uint16_t address) const;
  void Set(std::uint16_t address, std::int32_t value);

  // kAccess where any of the bytes is not defined.
  dynamixel::Code Read(std::uint16_t address, std::span<std::uint8_t> bytes) const;

  // Splits a write into items and calls `write(item, value)` for each; nothing is written when the
  // result is not kNone: kAccess (undefined, read-only, or EEPROM while `torque`), kLength (a part
  // of an item), kRange (beyond low and high).
  template <class Write>
  dynamixel::Code ForEachItem(std::uint16_t address, std::span<const std::uint8_t> bytes,
                              bool torque, Write write) const;

 private:
  static constexpr std::size_t kSize = 160;

  // The item of which this byte is part.
  const DynamixelItem* Find(std::size_t address) const {
    return address < kSize ? item_at_[address] : nullptr;
  }

  const DynamixelModel* model_;
  std::array<const DynamixelItem*, kSize> item_at_{};
  std::array<std::uint8_t, kSize> bytes_{};
};

// Little-endian, signed where `size` is that of a signed item (all are treated so).
std::int32_t FromBytes(std::span<const std::uint8_t> bytes);

template <class Write>
dynamixel::Code DynamixelTable::ForEachItem(std::uint16_t address,
                                            std::span<const std::uint8_t> bytes, bool torque,
                                            Write write) const {
  using dynamixel::Code;
  for (const bool check : {true, false}) {
    std::size_t done = 0;
    while (done < bytes.size()) {
      const DynamixelItem* item = Find(address + done);
      if (item == nullptr || !item->writable) return Code::kAccess;
      if (torque && item->address < dynamixel::kFirstOfRam) return Code::kAccess;
      if (item->address != address + done || bytes.size() - done < item->size) return Code::kLength;
      const std::int32_t value = FromBytes(bytes.subspan(done, item->size));
      if (value < item->low || value > item->high) return Code::kRange;
      if (!check) write(*item, value);
      done += item->size;
    }
  }
  return bytes.empty() ? Code::kLength : Code::kNone;
}

}  // namespace facewire::sim

#endif  // FACEWIRE_TESTS_SIM_DYNAMIXEL_TABLE_H_
