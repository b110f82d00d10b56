#ifndef FACEWIRE_TESTS_ANIMATRONIC_JUDGE_H_
#define FACEWIRE_TESTS_ANIMATRONIC_JUDGE_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/time.h"
#include "core/servo/motion.h"
#include "core/servo/servo_rig.h"

namespace facewire::stage {

// What must never happen, whatever goes wrong.
enum class Rule : std::uint8_t {
  kLimits,               // a command beyond min to max
  kSpeed,                // a step larger than the speed limit allows in the time that it had
  kAcceleration,         // a change of step, likewise; as it is told
  kLeap,                 // the servo's own path is faster than the speed it was given for itself
  kStrange,              // the bus took for a goal what nobody told
  kMotionAfterStop,      // a command changes after an emergency stop
  kTorqueAfterStop,      // torque on longer after it than Contract::stop_torque
  kTorqueAfterContract,  // torque on longer after the last wish than the contract
  kLinkage,              // a rule between two servos does not hold, or gets worse
};
constexpr std::size_t kRules = 9;
const char* Name(Rule rule);

struct Violation {
  Time at{};
  std::size_t servo = 0;
  Rule rule = Rule::kLimits;
  double found = 0;  // in the servo's own unit; of torque, seconds too long
  double allowed = 0;
};

// A servo at one instant, from its bus's own side (tests/sim).
struct Seen {
  bool torque = false;   // its motor is driven
  bool told = true;      // the bus has a goal for it; a motor may outlast that by a moment
  double goal = 0;       // as the bus understood what it was last told
  double commanded = 0;  // where the servo's own electronics are on the way there
  double position = 0;   // of the output shaft, true
  double sensed = 0;     // where it believes to be
};

// What may pass between a word and its deed, and what the servo has been given for itself.
struct Wire {
  double step = 1;       // of its commands
  Duration reaction{};   // from what is told to what the bus has taken: a tick and the bytes' time
  Duration lets_go{};    // from the bus's word to a motor without current
  Duration held_back{};  // a chain says nothing while it waits for a reply; but a stop
  // One damaged packet in 256 passes its checksum: a strange goal on a line that is known to be bad
  // is the protocol's fault. It is counted; within the limits and no leap it has to be all the
  // same.
  bool weak_sum = false;
  std::optional<double> home{};  // where a board sends its servo by itself
  double own_speed = 0;          // per second, of the servo's path; 0: no such path, or unlimited
};

// Watches every word to the servos and every millisecond of the servos, and writes down what breaks
// a rule. It is told what the host knew (wishes, stops, cut lines), and what it sees comes from the
// other side of the wire.
class Judge {
 public:
  // `wires` in the order of the rig's servos. The rig is copied.
  Judge(const servo::ServoRig& rig, std::vector<Wire> wires);

  // A usable wish, or a hand's, was passed on at `at`.
  void Wished(std::size_t servo, Time at);
  void Stopped(Time at);
  void Released();
  // Nobody can expect this servo to know what it is told before `until`.
  void Unheard(std::size_t servo, Time until);
  // The host's clock went back by so much: all its times end later.
  void Delayed(Duration by);
  // The commands of a tick; `tick` is the host's time since the last one.
  void Told(Time at, Duration tick, const servo::Commands& commands);
  // Once a millisecond, in the order of the rig's servos.
  void Look(Time at, std::span<const Seen> seen);

  // The first ones of each rule.
  const std::vector<Violation>& violations() const { return violations_; }
  std::size_t Count(Rule rule) const { return counts_[static_cast<std::size_t>(rule)]; }
  std::size_t Count() const;
  std::string Report() const;  // a line for each violation; empty without
  // How often it looked at a servo with torque, so that silence means something.
  std::uint64_t looks() const { return looks_; }
  // Goals that a damaged packet with a good checksum made (Wire::weak_sum).
  std::size_t forged() const { return forged_; }

 private:
  struct Word {
    Time at{};
    double position = 0;
    bool torque = false;
  };
  struct Servo {
    Wire wire;
    std::deque<Word> told;  // the newest last
    double change = 0;      // of the last tick, with torque in both
    double tick_s = 0;      // how long that was; 0: it does not count
    double since_change_s = 0;
    bool was_on = false;  // with a goal
    double goal = 0;
    double commanded = 0;
    std::optional<Time> agreed;  // when `goal` was last told
    std::optional<Time> wished;
    Time unheard{};
  };

  void Note(Time at, std::size_t servo, Rule rule, double found, double allowed);
  void ToldOne(Time at, double dt_s, std::size_t i, const servo::Command& command);
  void LookAtOne(Time at, std::size_t i, const Seen& seen);
  void LookAtGoal(Time at, std::size_t i, const Seen& seen);
  void LookAtTorque(Time at, std::size_t i);
  void CheckLinkages(Time at);

  servo::ServoRig rig_;
  std::vector<Servo> servos_;
  // Of each linkage how far it was off when it was last looked at, and since when both servos have
  // torque: in what is told, and at the bus.
  struct Broken {
    double by = 0;
    std::optional<Time> both_on;

    // Whether it may be so: a servo whose torque came on where somebody had moved it may be outside
    // a rule. Then the other one brakes, and from there on it only gets better.
    bool MayBe(Time at, double broken, Duration braking);
  };
  struct Link {
    Broken told, seen;
    Duration braking{};
  };
  std::vector<Link> links_;
  Duration contract_{};
  std::optional<Time> stopped_;
  std::vector<Violation> violations_;
  std::array<std::size_t, kRules> counts_{};
  std::uint64_t looks_ = 0;
  std::size_t forged_ = 0;
};

}  // namespace facewire::stage

#endif  // FACEWIRE_TESTS_ANIMATRONIC_JUDGE_H_
