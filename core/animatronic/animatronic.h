#ifndef FACEWIRE_CORE_ANIMATRONIC_ANIMATRONIC_H_
#define FACEWIRE_CORE_ANIMATRONIC_ANIMATRONIC_H_

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "core/base/capacity.h"
#include "core/base/inline_vector.h"
#include "core/base/result.h"
#include "core/base/time.h"
#include "core/bus/servo_bus.h"
#include "core/servo/mapper.h"
#include "core/servo/motion.h"
#include "core/servo/servo_rig.h"

namespace facewire::animatronic {

// A bus, and which servos of a rig hang on it.
struct Attachment {
  bus::ServoBus* driver = nullptr;                  // configured; borrowed
  Duration period = std::chrono::milliseconds(10);  // from tick to tick, > 0
  InlineVector<std::uint8_t, kMaxServos> servos;    // indices into ServoRig::servos, in the
                                                    // order of the driver's BusConfig::servos
};

// The part of a bus's configuration that a servo of the rig decides: id, limits, neutral, the pace
// of an arrival (its crawl) and the speed that it may have by itself (a quarter above the rig's).
bus::ServoConfig ConfigOf(const servo::Servo& servo, const bus::GuardConfig& guard) noexcept;

// All servos of a character on all their buses, moved by one Motion: wishes in, bytes out; bytes
// in, feedback out. What the servos say about themselves (position, heat, load, absence) decides
// where motion begins and how fast it may be. README.md here shows one tick.
//
// It owns no port and no clock; one thread. `now` of all calls is of one clock.
class Animatronic {
 public:
  // Both are copied from but for the drivers. kInvalidArgument: a servo hangs on no bus or on two,
  // an attachment without a driver or period or with other servos than its driver, more buses than
  // kMaxBuses; else as Motion::Configure. Nothing is usable then.
  Result<> Configure(const servo::ServoRig& rig, std::span<const Attachment> buses) noexcept;

  // As those of Motion.
  void Take(const servo::Wishes& wishes, Time now) noexcept { motion_.Take(wishes, now); }
  void SetManual(std::size_t servo, float position, Time now) noexcept {
    motion_.SetManual(servo, position, now);
  }
  // From now on nothing moves; each bus's next bytes are what lets go of its servos, at once and
  // whatever else it was saying (after Contract::stop_torque, where the rig has one).
  void Stop() noexcept;
  void Release() noexcept { motion_.Release(); }
  bool stopped() const noexcept { return motion_.stopped(); }

  // One tick, at the rate of the fastest bus: first what came from each port, then Update, then
  // for each bus what to write to its port; empty when it is not this bus's turn, or it has nothing
  // to say. The bytes are valid until the bus's next call.
  void Receive(std::size_t bus, std::span<const std::byte> bytes, Time now) noexcept;
  void Update(Time now) noexcept;
  std::span<const std::byte> Bytes(std::size_t bus, Time now) noexcept;

  // The end: from now on no servo gets torque, and each bus's next bytes let go of its servos.
  // Ticks should go on until Limp, or for a while: what is lost is said again.
  void LetGo() noexcept;
  // Whether all servos that answer have said that they have no torque.
  bool Limp() const noexcept;
  // The port was opened (again): its servos are found anew.
  void Restart(std::size_t bus) noexcept;
  // As ServoBus::Reboot, by index into ServoRig::servos.
  Result<> Reboot(std::size_t servo) noexcept;

  // Of the fastest bus.
  Duration period() const noexcept { return period_; }
  std::size_t buses() const noexcept { return buses_.size(); }
  std::size_t servos() const noexcept { return places_.size(); }
  // Of the last Update, in the order of ServoRig::servos.
  const servo::Commands& commands() const noexcept { return *commands_; }
  const bus::ServoFeedback& feedback(std::size_t servo) const noexcept;
  const bus::BusStatus& status(std::size_t bus) const noexcept {
    return buses_[bus].wiring.driver->status();
  }
  std::size_t bus_of(std::size_t servo) const noexcept { return places_[servo].bus; }

 private:
  struct Place {  // of a servo
    std::size_t bus = 0;
    std::size_t index = 0;       // in its bus's configuration
    std::optional<Time> read{};  // the position that was passed on last
  };
  struct Line {
    Attachment wiring;
    std::optional<Time> next{};  // its turn; none before the first
    bool let_go = false;         // the next bytes are a release
  };

  Result<> Attach(std::span<const Attachment> buses, std::span<servo::Actuator> actuators) noexcept;
  void TakeFeedback(Time now) noexcept;
  bool AnyTorque() const noexcept;

  servo::Motion motion_;
  const servo::Commands* commands_ = &kNone;
  InlineVector<Place, kMaxServos> places_;
  InlineVector<Line, kMaxBuses> buses_;
  std::array<bus::ServoCommand, kMaxServos> told_{};  // of one bus, in its order
  Duration period_{};
  bool holding_stop_ = false;  // stopped, but still with torque
  bool over_ = false;          // by LetGo

  static constexpr servo::Commands kNone{};
};

}  // namespace facewire::animatronic

#endif  // FACEWIRE_CORE_ANIMATRONIC_ANIMATRONIC_H_
