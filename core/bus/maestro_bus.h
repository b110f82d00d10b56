#ifndef FACEWIRE_CORE_BUS_MAESTRO_BUS_H_
#define FACEWIRE_CORE_BUS_MAESTRO_BUS_H_

#include "core/bus/packet_buffer.h"
#include "core/bus/servo_bus.h"
#include "core/wire/maestro/maestro.h"

namespace facewire::bus {

struct MaestroConfig {
  BusConfig bus;  // ids are channels; baud 0 would be USB: any high rate will do
  wire::maestro::Line line;
  bool multi_target = false;  // Mini Maestro 12, 18, 24; a Micro Maestro 6 has no such command
  bool answers = true;        // false: the board's TX is not connected, and nothing is asked
};

// A Pololu Maestro (core/wire/maestro). It knows pulses, not servos: "position" is the pulse that
// it sends, torque is whether it sends any, and nobody tells of heat or load. What it holds (serial
// timeout, CRC mode, homes, pulse limits) cannot be read over this line; what can be inferred goes
// to BusStatus: errors, and pulses that are not what was told.
//
// A servo without pulses has no position that anybody knows, and its first pulse cannot be
// slowed down by anybody: servos get theirs one after the other, torque_interval apart.
class MaestroBus final : public ServoBus {
 public:
  // kOutOfRange: no servo, a channel above 23 or given twice, min..max not within 64 us to 4080
  // us, or another number that makes no sense.
  Result<> Configure(const MaestroConfig& config) noexcept;

  void Receive(std::span<const std::byte> bytes, Time now) noexcept override;
  std::span<const std::byte> Tick(Time now,
                                  std::span<const ServoCommand> commands) noexcept override;
  std::span<const std::byte> Release(Time now) noexcept override;
  void Restart() noexcept override;
  Result<> Reboot(std::size_t servo) noexcept override;  // kUnsupported
  std::span<const ServoFeedback> feedback() const noexcept override { return feedback_.span(); }
  const BusStatus& status() const noexcept override { return status_; }
  BusTraits traits() const noexcept override {
    return {.step = 1.0F / wire::maestro::kStepsPerMicrosecond, .reads_back = false};
  }

 private:
  enum class Stage : std::uint8_t { kResync, kKnock, kRead, kServe };

  struct Channel {
    std::uint16_t low = 0, high = 0;  // 0.25 us
    std::optional<std::uint16_t> goal;
    bool wants = false;
    std::uint16_t sent = 0;  // 0: no pulses
    std::optional<Time> sent_at;
    std::optional<Time> changed_at;
    bool pulsing = false;           // it may have pulses
    bool seen = false;              // they were read back since it has them
    bool missed = false;            // ... and once they were not
    std::optional<Time> let_go_at;  // the board ended them by itself
  };

  void Obey(std::span<const ServoCommand> commands, Time now) noexcept;
  void WriteTargets(Time now, bool release) noexcept;
  void WriteQuestion(Time now) noexcept;
  void Ask(wire::maestro::Reply reply, Time now) noexcept;
  void Lost(Time now) noexcept;
  void TookPosition(std::size_t i, std::uint16_t value, Time now) noexcept;
  void TookErrors(std::uint16_t errors) noexcept;
  void SetAll(ServoState state) noexcept;
  void Summarise(Time now) noexcept;

  MaestroConfig config_;
  wire::maestro::Encoder encoder_;
  wire::maestro::ReplyReader reader_;
  InlineVector<Channel, kMaxServos> channels_;
  InlineVector<ServoFeedback, kMaxServos> feedback_;
  BusStatus status_;
  Stage stage_ = Stage::kResync;
  std::size_t turn_ = 0;   // whose position is asked for
  std::size_t asked_ = 0;  // the one that is out
  bool errors_next_ = false;
  bool again_ = false;  // the same position once more
  std::uint8_t lost_in_row_ = 0;
  bool knocked_ = false;  // it was tried at all
  std::optional<Time> deadline_, quiet_until_, torque_at_;
  PacketBuffer out_;
};

}  // namespace facewire::bus

#endif  // FACEWIRE_CORE_BUS_MAESTRO_BUS_H_
