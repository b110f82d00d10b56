#ifndef FACEWIRE_CORE_BUS_CHAIN_BUS_H_
#define FACEWIRE_CORE_BUS_CHAIN_BUS_H_

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "core/bus/packet_buffer.h"
#include "core/bus/servo_bus.h"

namespace facewire::bus {

// What all chains of servos with ids on one half-duplex line have in common: who is asked when, and
// how a servo comes to its torque. How it is said is the protocol's, below.
//
// Every servo goes its own way, kAbsent -> kChecking -> kLimp -> kArming -> kOn, so one that was
// unplugged, rebooted or had its supply cut comes back by the same steps:
//   kChecking  its settings, its torque, and two positions that agree
//   kArming    it is told its goal (and its watchdog, and to be slow); when it repeats that
//              correctly, it gets its torque: a lost packet can never turn an old goal into a jump
//   kOn        changed goals at once, all others each `refresh`; slow until it has arrived
// Nothing is said while a reply is due. At most one question a tick, and the line is left to the
// goals for all but feedback_share of the time.
class ChainBus : public ServoBus {
 public:
  ChainBus(const ChainBus&) = delete;
  ChainBus& operator=(const ChainBus&) = delete;

  void Receive(std::span<const std::byte> bytes, Time now) noexcept final;
  std::span<const std::byte> Tick(Time now, std::span<const ServoCommand> commands) noexcept final;
  std::span<const std::byte> Release(Time now) noexcept final;
  void Restart() noexcept final;
  Result<> Reboot(std::size_t servo) noexcept final;
  std::span<const ServoFeedback> feedback() const noexcept final { return feedback_.span(); }
  const BusStatus& status() const noexcept final { return status_; }
  BusTraits traits() const noexcept final { return {.step = 1, .reads_back = true}; }

 protected:
  // The registers that belong together. Where a servo has gaps between them, a block has parts,
  // which are asked for one after the other.
  enum class Block : std::uint8_t {
    kSettings,  // EEPROM, once after a servo was found
    kHealth,    // what was told to it: torque, goal, speed, watchdog
    kStatus,    // what it does
  };
  struct Goal {
    std::size_t servo = 0;  // index
    std::uint8_t id = 0;
    std::int32_t counts = 0;
    bool slow = false;  // by arrive_speed_per_s and arrive_acceleration_per_s2
  };
  struct Answer {
    std::uint8_t id = 0;
    bool good = false;   // carries the data that was asked for
    bool alert = false;  // says that something is wrong, and kHealth would tell what
    std::span<const std::byte> data;
  };
  struct Health {
    bool torque = false;
    std::int32_t goal = 0;
    bool slow = false;     // has the pace of an arrival
    bool normal = false;   // has the pace of all that comes after
    bool watched = false;  // the bus's own watchdog is set and has not tripped; or there is none
    std::optional<HardwareFaults> faults;  // where this block tells
  };
  struct Reading {
    std::int32_t position = 0;
    std::optional<float> temperature_c;
    std::optional<float> load;
    std::optional<float> voltage_v;
    std::optional<HardwareFaults> faults;
  };

  ChainBus() noexcept = default;
  ~ChainBus() = default;

  // kOutOfRange: no servo, an id above max_id or given twice, no whole count from min to max, or
  // another number of the configuration that makes no sense. Nothing is changed then.
  Result<> ConfigureChain(const BusConfig& config, std::uint8_t max_id) noexcept;
  const BusConfig& config() const noexcept { return config_; }
  // Notes that a servo's setting is not as wanted, or, when `fine`, that it is (again).
  void Compare(const Finding& finding, bool fine) noexcept {
    NoteFinding(status_.findings, finding, fine);
  }

 private:
  // The protocol. Make... functions write packets to the beginning of `out`, which has room, and
  // return how many bytes.
  virtual std::size_t MakeGoals(std::span<const Goal> goals, std::span<std::byte> out) noexcept = 0;
  // All that has to be known to a servo before it may get torque.
  virtual std::size_t MakeArming(const Goal& goal, std::span<std::byte> out) noexcept = 0;
  virtual std::size_t MakePace(const Goal& goal, std::span<std::byte> out) noexcept = 0;
  virtual std::size_t MakeTorque(std::span<const std::uint8_t> ids, bool on,
                                 std::span<std::byte> out) noexcept = 0;
  virtual std::size_t MakeRelease(std::span<std::byte> out) noexcept = 0;
  virtual std::size_t MakeReboot(std::uint8_t id, std::span<std::byte> out) noexcept = 0;
  // From here on answers to this question, and only these, are returned by NextAnswer.
  virtual std::size_t MakeQuestion(Block block, std::size_t part, std::span<const std::uint8_t> ids,
                                   std::span<std::byte> out) noexcept = 0;
  virtual std::optional<Answer> NextAnswer(std::span<const std::byte>& bytes) noexcept = 0;
  virtual void ForgetAnswers() noexcept = 0;
  virtual std::size_t Parts(Block block) const noexcept = 0;
  virtual std::size_t AnswerBytes(Block block, std::size_t part) const noexcept = 0;
  virtual std::size_t MostAsked() const noexcept = 0;  // servos in one question
  virtual bool Echoes() const noexcept = 0;
  // Whether the servo may move; all of them go to Compare.
  virtual bool TakeSettings(std::size_t servo, std::size_t part,
                            std::span<const std::byte> data) noexcept = 0;
  // Adds what this part says.
  virtual void TakeHealth(std::size_t servo, std::size_t part, std::span<const std::byte> data,
                          Health& health) noexcept = 0;
  virtual Reading TakeStatus(std::size_t servo, std::span<const std::byte> data) noexcept = 0;

  struct Member {
    std::int32_t low = 0, high = 0;  // counts
    Guard guard;
    HardwareFaults faults = 0;
    // What it should do.
    std::optional<std::int32_t> goal;
    bool wants = false;  // torque
    // What it was told.
    std::int32_t sent = 0;
    std::optional<Time> sent_at;                                    // none: has to be told (again)
    bool prepared = false, confirmed = false, torque_sent = false;  // while kArming
    bool arriving = false;
    bool hurry = false;     // has arrived: may be told to be fast
    bool off_known = true;  // it is without torque, or nobody has ever asked
    std::optional<Time> off_at;
    bool reboot = false;
    // What it said.
    bool settings_read = false, looked = false;
    std::optional<std::int32_t> reading;  // the last one
    std::int32_t rests_at = 0;
    Time rests_since{};
    std::optional<Time> looked_at, tried_at;
    bool look_now = false;
    std::uint8_t settings_part = 0, look_part = 0;  // the next ones
    bool unusable = false;                          // so far
    Health health;                                  // of the parts so far
    std::uint8_t lost_in_row = 0;
  };

  ServoState& state(std::size_t i) noexcept { return feedback_[i].state; }
  Goal GoalOf(std::size_t i) const noexcept;
  void Forget(std::size_t i) noexcept;
  void Drop(std::size_t i) noexcept;  // ends its torque with the next tick
  // Something was told to it: kHealth is read from its beginning.
  static void LookSoon(Member& member) noexcept {
    member.look_now = true;
    member.look_part = 0;
  }

  void Obey(std::span<const ServoCommand> commands) noexcept;
  void WriteOff(Time now, PacketBuffer& out) noexcept;
  void WriteArming(Time now, PacketBuffer& out) noexcept;
  void WriteGoals(Time now, PacketBuffer& out) noexcept;
  bool WriteReboot(Time now, PacketBuffer& out) noexcept;

  bool WriteQuestion(Time now, PacketBuffer& out) noexcept;
  bool PickQuestion(Time now) noexcept;
  bool PickLook(Time now, bool only_urgent) noexcept;
  bool PickStatus() noexcept;
  bool PickAbsent(Time now) noexcept;
  void PickOne(Block block, std::size_t part, std::size_t i) noexcept;
  void GiveUpReplies() noexcept;

  void Took(std::size_t i, std::span<const std::byte> data, Time now) noexcept;
  void TookSettings(std::size_t i, std::span<const std::byte> data) noexcept;
  void TookHealth(std::size_t i, const Health& health, Time now) noexcept;
  void TookReading(std::size_t i, const Reading& reading, Time now) noexcept;
  void Summarise(Time now) noexcept;

  BusConfig config_;
  InlineVector<Member, kMaxServos> members_;
  InlineVector<ServoFeedback, kMaxServos> feedback_;
  BusStatus status_;

  Block block_ = Block::kStatus;  // of the question that is out, or picked
  std::size_t part_ = 0;
  InlineVector<std::uint8_t, kMaxServos> asked_;  // indices; those that have not answered
  bool asking_ = false;                           // a question is out
  std::optional<Time> deadline_;                  // nothing is said before
  std::optional<Time> ask_again_;                 // when the line has had its rest
  std::optional<Time> hunted_;                    // for somebody absent
  std::optional<Time> torque_at_;                 // somebody got torque
  std::size_t turn_ = 0;                          // of the servos, for kStatus
  std::size_t look_turn_ = 0;                     // for kHealth
  int looks_in_row_ = 0;
  PacketBuffer out_;
};

}  // namespace facewire::bus

#endif  // FACEWIRE_CORE_BUS_CHAIN_BUS_H_
