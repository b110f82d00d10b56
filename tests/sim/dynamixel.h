#ifndef FACEWIRE_TESTS_SIM_DYNAMIXEL_H_
#define FACEWIRE_TESTS_SIM_DYNAMIXEL_H_

#include <cstdint>
#include <span>
#include <vector>

#include "tests/sim/bus.h"
#include "tests/sim/dynamixel_servo.h"

namespace facewire::sim {

struct DynamixelOptions : BusOptions {
  // The model's servo and supply; baud 57600 as from the works.
  explicit DynamixelOptions(const DynamixelModel& servo_model = Xl330());

  const DynamixelModel* model;
  // Whether torque on makes the present position the goal. The manuals do not say; without it a
  // goal from before is the harder case for a host.
  bool holds_at_torque_on = false;
  std::vector<std::uint8_t> ids = {1};
};

// A chain of X-series servos on one half-duplex wire, Protocol 2.0. Position in counts, 0..4095,
// 2048 in the middle. All servos of a chain begin with the line's baud rate in their memory.
class Dynamixel final : public Bus {
 public:
  explicit Dynamixel(const DynamixelOptions& options);

  double Goal(std::size_t index) const override {
    return chain_[index].table().Get(dynamixel::kGoalPosition);
  }
  double Commanded(std::size_t index) const override { return chain_[index].trajectory(); }
  double ToOwn(double rad) const override { return 2048 + rad * kCountsPerRad; }
  double ToRad(double own) const override { return (own - 2048) / kCountsPerRad; }

  // An entry of a servo's table, for tests: read as the servo would send it, or set behind the
  // protocol's back (to prepare a servo that an earlier owner has configured).
  std::int32_t Entry(std::size_t index, std::uint16_t address);
  void SetEntry(std::size_t index, std::uint16_t address, std::int32_t value);

 private:
  static constexpr double kCountsPerRad = 4096 / (2 * std::numbers::pi);

  void OnByte(std::uint8_t byte, Nanos at) override;
  void OnMillisecond(Time at) override;
  void OnPowerUp(std::size_t index) override { chain_[index].Start(); }

  void OnPacket(Nanos at);
  void OnInstruction(std::uint8_t id, std::uint8_t instruction,
                     std::span<const std::uint8_t> params, Nanos at);
  void PingAll(Nanos at);
  void SyncRead(std::span<const std::uint8_t> params, Nanos at);
  void SyncWrite(std::span<const std::uint8_t> params);
  void BulkRead(std::span<const std::uint8_t> params, Nanos at);
  void BulkWrite(std::span<const std::uint8_t> params);
  void Single(std::size_t index, bool broadcast, std::uint8_t instruction,
              std::span<const std::uint8_t> params, Nanos at);
  // Returns when the answer is out; kNever when the servo is not there.
  Nanos AnswerRead(std::uint8_t id, std::uint16_t address, std::uint16_t length, Nanos at);
  Nanos Answer(std::size_t index, dynamixel::Code code, std::span<const std::uint8_t> params,
               Nanos at);
  bool Hears(std::size_t index) const;
  int IndexOf(std::uint8_t id) const;  // -1: nobody who hears

  std::vector<DynamixelServo> chain_;
  std::vector<std::uint8_t> packet_;  // from its first FF
  Nanos last_byte_ = 0;
};

}  // namespace facewire::sim

#endif  // FACEWIRE_TESTS_SIM_DYNAMIXEL_H_
