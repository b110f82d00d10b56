#ifndef FACEWIRE_CORE_BUS_RECEIVER_BUS_H_
#define FACEWIRE_CORE_BUS_RECEIVER_BUS_H_

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "core/base/inline_vector.h"
#include "core/base/result.h"
#include "core/bus/packet_buffer.h"
#include "core/bus/servo_bus.h"
#include "core/wire/decoder.h"
#include "core/wire/encoder.h"
#include "core/wire/servo_message.h"

namespace facewire::bus {

// What the receiver itself does when the device falls silent, by its own clock: the pulses stay for
// `hold`, go to neutral within `ease`, stay there for `release`, and end. Kept in whole
// milliseconds.
struct ReceiverConfig {
  BusConfig bus;  // ids are the receiver's outputs, from 0
  Duration hold = std::chrono::milliseconds(400);
  Duration ease = std::chrono::milliseconds(1500);
  Duration release = std::chrono::milliseconds(5000);
};

// A receiver of servo pulses that speaks the native protocol (tools/firmware; core/wire/README.md,
// Receivers of servo pulses). It is given the limits of every servo and the failsafe's times before
// it moves any, and has a status of its own, once a second and when its state changes.
//
// It knows pulses, not servos: "position" is the pulse that it makes, torque is whether it makes
// one, and nobody tells of heat or load; voltage_v is its processor's supply. Whenever pulses
// start, and when frames come again after a silence, the receiver crawls from where it left its
// servos, each by itself: until it has caught up, it is behind the commands.
class ReceiverBus final : public ServoBus {
 public:
  // kOutOfRange: no servo, an id beyond kMaxServos or given twice, min..max not within 500 to 2500
  // us, neutral not within min..max, a time that is negative or above 2^32 ms, or another number
  // that makes no sense.
  Result<> Configure(const ReceiverConfig& config) noexcept;

  void Receive(std::span<const std::byte> bytes, Time now) noexcept override;
  std::span<const std::byte> Tick(Time now,
                                  std::span<const ServoCommand> commands) noexcept override;
  std::span<const std::byte> Release(Time now) noexcept override;
  void Restart() noexcept override;
  Result<> Reboot(std::size_t servo) noexcept override;  // kUnsupported
  std::span<const ServoFeedback> feedback() const noexcept override { return feedback_.span(); }
  const BusStatus& status() const noexcept override { return status_; }
  BusTraits traits() const noexcept override { return {.step = 0.25F, .reads_back = false}; }

  // What the receiver last said about itself (state, firmware, why it started, what it lost and
  // refused); none before its first status.
  const std::optional<wire::ReceiverStatus>& receiver() const noexcept { return receiver_; }

 private:
  enum class Stage : std::uint8_t {
    kSeek,   // nothing heard
    kSetup,  // it has another setup, or none
    kServe,
  };

  struct Channel {
    std::uint16_t low = 0, high = 0;  // 0.25 us
    std::optional<std::uint16_t> goal{};
    bool wants = false;
    std::uint16_t sent = 0;           // 0: no pulses
    std::optional<Time> on_at{};      // since when it is told a pulse
    std::optional<Time> let_go_at{};  // the receiver ended its pulses by itself
  };

  wire::ServoLimits LimitsOf(std::size_t i) const noexcept;
  void MakeSetup() noexcept;
  void Obey(std::span<const ServoCommand> commands, Time now) noexcept;
  void WatchSilence(Time now) noexcept;
  void WriteSetup(Time now) noexcept;
  void WritePulses(Time now, bool at_once) noexcept;
  template <class Message>
  void Say(const Message& message, Time now) noexcept;
  void TookStatus(const wire::ReceiverStatus& said, Time now) noexcept;
  void TookCapacity(std::uint8_t capacity) noexcept;
  void TookPulse(std::size_t i, std::uint16_t width, Time now) noexcept;
  void SetAll(ServoState state) noexcept;
  void Summarise() noexcept;

  ReceiverConfig config_;
  wire::ServoSetup setup_;
  wire::Encoder encoder_;
  wire::Decoder decoder_;
  InlineVector<Channel, kMaxServos> channels_;
  InlineVector<ServoFeedback, kMaxServos> feedback_;
  BusStatus status_;
  std::optional<wire::ReceiverStatus> receiver_;
  Stage stage_ = Stage::kSeek;
  std::size_t capacity_ = kMaxServos;  // until it says less
  bool fell_silent_ = false;           // it was heard before
  bool released_ = false;              // nobody has asked for torque since
  bool echoes_ = false;
  std::uint32_t unanswered_ = 0;  // setups, in a row
  std::uint32_t missed_ = 0;      // statuses, in a row
  std::optional<Time> setup_at_, sent_at_, torque_at_, status_due_, line_free_;
  PacketBuffer out_;
};

}  // namespace facewire::bus

#endif  // FACEWIRE_CORE_BUS_RECEIVER_BUS_H_
