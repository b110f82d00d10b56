#ifndef FACEWIRE_TESTS_SIM_FEETECH_H_
#define FACEWIRE_TESTS_SIM_FEETECH_H_

#include <cstdint>
#include <span>
#include <vector>

#include "tests/sim/bus.h"
#include "tests/sim/feetech_servo.h"

namespace facewire::sim {

struct FeetechOptions : BusOptions {
  // The series' servo and supply; 1 Mbaud as from the works.
  explicit FeetechOptions(const FeetechSeries& servo_series = Sts());

  const FeetechSeries* series;
  std::vector<std::uint8_t> ids = {1};
};

// A chain of Feetech bus servos on one half-duplex wire. Position in counts: 0..4095 over a turn
// (STS), 0..1023 over 300 degrees (SCS). All servos of a chain begin with the line's baud rate.
class Feetech final : public Bus {
 public:
  explicit Feetech(const FeetechOptions& options);

  double Goal(std::size_t index) const override { return chain_[index].goal(); }
  double Commanded(std::size_t index) const override { return chain_[index].commanded(); }
  double ToOwn(double rad) const override { return middle_ + rad * counts_per_rad_; }
  double ToRad(double own) const override { return (own - middle_) / counts_per_rad_; }

  // A servo's memory, for tests.
  FeetechServo& memory(std::size_t index) { return chain_[index]; }

 private:
  void OnByte(std::uint8_t byte, Nanos at) override;
  void OnMillisecond(Time at) override;
  void OnPowerUp(std::size_t index) override { chain_[index].Start(); }

  void OnPacket(Nanos at);
  void OnInstruction(std::size_t index, bool broadcast, std::uint8_t instruction,
                     std::span<const std::uint8_t> params, Nanos at);
  void SyncWrite(std::span<const std::uint8_t> params);
  void SyncRead(std::span<const std::uint8_t> params, Nanos at);
  Nanos Answer(std::size_t index, std::span<const std::uint8_t> params, Nanos at);
  bool Hears(std::size_t index) const;

  double middle_, counts_per_rad_;
  std::vector<FeetechServo> chain_;
  std::vector<std::uint8_t> packet_;  // from its first FF
  Nanos last_byte_ = 0;
};

}  // namespace facewire::sim

#endif  // FACEWIRE_TESTS_SIM_FEETECH_H_
