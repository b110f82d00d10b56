#ifndef FACEWIRE_CORE_BUS_DYNAMIXEL_BUS_H_
#define FACEWIRE_CORE_BUS_DYNAMIXEL_BUS_H_

#include <array>
#include <chrono>

#include "core/bus/chain_bus.h"
#include "core/wire/dynamixel/packet.h"
#include "core/wire/dynamixel/registers.h"
#include "core/wire/dynamixel/status.h"

namespace facewire::bus {

struct DynamixelConfig {
  BusConfig bus;
  // A servo that hears nothing for so long stops by itself: in steps of 20 ms up to 2.54 s, and
  // several times the refresh.
  Duration watchdog = std::chrono::milliseconds(500);
  wire::dynamixel::OperatingMode mode = wire::dynamixel::OperatingMode::kPosition;
  // What has to switch torque off in the servo itself.
  HardwareFaults shutdown =
      Bit(HardwareFault::kHeat) | Bit(HardwareFault::kShock) | Bit(HardwareFault::kOverload);
  Duration max_return_delay = std::chrono::microseconds(500);  // as delivered
};

// A chain of Dynamixels of the X series (core/wire/dynamixel). Their own bus watchdog stops them
// when the line is cut; it is set each time before torque comes on.
class DynamixelBus final : public ChainBus {
 public:
  // kOutOfRange: as ChainBus says, or the watchdog is not 20 ms to 2.54 s, or is less than three
  // times the refresh.
  Result<> Configure(const DynamixelConfig& config) noexcept;

  // The packet that writes a setting into a servo's EEPROM, for an operator's explicit command; the
  // servo takes it only while it has no torque, and acknowledges. Values as in Finding.
  // kUnsupported: not a setting of these servos; kOutOfRange: the id, or a value that the register
  // cannot hold.
  static Result<std::span<const std::byte>> MakeSetting(std::uint8_t id, Setting setting,
                                                        std::int32_t value,
                                                        std::span<std::byte> out) noexcept;

 private:
  std::size_t MakeGoals(std::span<const Goal> goals, std::span<std::byte> out) noexcept override;
  std::size_t MakeArming(const Goal& goal, std::span<std::byte> out) noexcept override;
  std::size_t MakePace(const Goal& goal, std::span<std::byte> out) noexcept override;
  std::size_t MakeTorque(std::span<const std::uint8_t> ids, bool on,
                         std::span<std::byte> out) noexcept override;
  std::size_t MakeRelease(std::span<std::byte> out) noexcept override;
  std::size_t MakeReboot(std::uint8_t id, std::span<std::byte> out) noexcept override;
  std::size_t MakeQuestion(Block block, std::size_t part, std::span<const std::uint8_t> ids,
                           std::span<std::byte> out) noexcept override;
  std::optional<Answer> NextAnswer(std::span<const std::byte>& bytes) noexcept override;
  void ForgetAnswers() noexcept override { reader_.Reset(); }
  std::size_t Parts(Block block) const noexcept override;
  std::size_t AnswerBytes(Block block, std::size_t part) const noexcept override;
  std::size_t MostAsked() const noexcept override { return 4; }
  bool Echoes() const noexcept override { return reader_.stats().instructions != 0; }
  bool TakeSettings(std::size_t servo, std::size_t part,
                    std::span<const std::byte> data) noexcept override;
  void TakeHealth(std::size_t servo, std::size_t part, std::span<const std::byte> data,
                  Health& health) noexcept override;
  Reading TakeStatus(std::size_t servo, std::span<const std::byte> data) noexcept override;

  // The eight bytes of a servo's profile, acceleration first.
  std::array<std::byte, 8> ProfileOf(std::size_t servo, bool slow) const noexcept;

  DynamixelConfig dynamixel_;
  wire::dynamixel::StatusReader reader_;
  std::size_t wanted_bytes_ = 0;                          // of data in an answer
  bool optional_ = false;                                 // some servos have no such register
  std::array<std::uint16_t, kMaxServos> full_current_{};  // 0: the servo measures load instead
};

}  // namespace facewire::bus

#endif  // FACEWIRE_CORE_BUS_DYNAMIXEL_BUS_H_
