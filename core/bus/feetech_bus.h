#ifndef FACEWIRE_CORE_BUS_FEETECH_BUS_H_
#define FACEWIRE_CORE_BUS_FEETECH_BUS_H_

#include "core/bus/chain_bus.h"
#include "core/wire/feetech/packet.h"
#include "core/wire/feetech/registers.h"
#include "core/wire/feetech/status.h"

namespace facewire::bus {

enum class FeetechSeries : std::uint8_t { kSts, kScs };  // SMS servos are kSts

struct FeetechConfig {
  BusConfig bus;
  FeetechSeries series = FeetechSeries::kSts;
  bool sync_read = true;  // ask several at once; some SCS servos do not know it
  // What goes into the speed register for "as fast as it can": more than any of them does, in
  // either unit, because 0 means that to some and "stop" to others.
  std::int32_t full_speed = 4000;
  std::uint8_t acceleration = 0;  // 100 counts/s^2; 0: unlimited, as the motion limits it already
  // What has to switch torque off in the servo itself; STS and SMS.
  HardwareFaults shutdown = Bit(HardwareFault::kHeat) | Bit(HardwareFault::kOverload);
};

// A chain of Feetech servos (core/wire/feetech). They have no watchdog: when the line is cut they
// hold their last goal for ever, so whoever drives them has to call Release in time, and a
// supply that a watchdog of the board's own can cut is worth its price.
class FeetechBus final : public ChainBus {
 public:
  // kOutOfRange: as ChainBus says, or the full speed is below 1 or above 32767.
  Result<> Configure(const FeetechConfig& config) noexcept;

  // Three packets that unlock a servo's EEPROM, write a setting and lock it again, for an
  // operator's explicit command. Each is acknowledged: write them one after the other. Values as in
  // Finding. kUnsupported: not a setting of these servos; kOutOfRange: the id, or a value that the
  // register cannot hold; kFull.
  struct SettingPackets {
    std::span<const std::byte> unlock, write, lock;
  };
  static Result<SettingPackets> MakeSetting(FeetechSeries series, std::uint8_t id, Setting setting,
                                            std::int32_t value, std::span<std::byte> out) noexcept;

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
  void ForgetAnswers() noexcept override { reader_.Forget(); }
  std::size_t Parts(Block /*block*/) const noexcept override { return 1; }
  std::size_t AnswerBytes(Block block, std::size_t part) const noexcept override;
  std::size_t MostAsked() const noexcept override { return feetech_.sync_read ? 4 : 1; }
  bool Echoes() const noexcept override { return reader_.stats().instructions != 0; }
  bool TakeSettings(std::size_t servo, std::size_t part,
                    std::span<const std::byte> data) noexcept override;
  void TakeHealth(std::size_t servo, std::size_t part, std::span<const std::byte> data,
                  Health& health) noexcept override;
  Reading TakeStatus(std::size_t servo, std::span<const std::byte> data) noexcept override;

  bool sts() const noexcept { return feetech_.series == FeetechSeries::kSts; }
  wire::feetech::ByteOrder order() const noexcept {
    return sts() ? wire::feetech::ByteOrder::kLowFirst : wire::feetech::ByteOrder::kHighFirst;
  }
  std::uint16_t SpeedOf(std::size_t servo, bool slow) const noexcept;
  std::uint8_t AccelerationOf(std::size_t servo, bool slow) const noexcept;

  FeetechConfig feetech_;
  wire::feetech::StatusReader reader_;
  std::uint8_t errors_ = 0;  // of the answer that is being taken
  std::array<std::uint8_t, kMaxServos> counts_per_speed_{};
};

}  // namespace facewire::bus

#endif  // FACEWIRE_CORE_BUS_FEETECH_BUS_H_
