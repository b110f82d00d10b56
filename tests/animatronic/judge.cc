#include "tests/animatronic/judge.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <utility>

namespace facewire::stage {
namespace {

using std::chrono::milliseconds;

constexpr std::size_t kKept = 20;  // violations of a rule
// Words to a servo: four seconds of them. A receiver that was cut off still has the last one it
// heard when it is heard again.
constexpr std::size_t kRemembered = 400;
constexpr double kRounding = 1e-3;  // floats carry positions to a part in ten million
constexpr Duration kLook = milliseconds(1);
constexpr Duration kTwoTicks = milliseconds(20);

double InSeconds(Duration d) { return std::chrono::duration<double>(d).count(); }

// From full speed to rest.
Duration BrakingTime(const servo::Servo& servo) {
  if (servo.max_acceleration_per_s2 == 0) return {};
  const double seconds = double{servo.max_speed_per_s} / servo.max_acceleration_per_s2;
  return Duration(static_cast<std::int64_t>(seconds * 1e6));
}

// How far the rule is from holding, in the unit of the servo that yields; <= 0: it holds.
double Excess(const servo::Linkage& rule, double yields, double other) {
  const double bound = double{rule.gain} * other + rule.offset;
  return rule.relation == servo::Relation::kAtLeast ? bound - yields : yields - bound;
}

}  // namespace

const char* Name(Rule rule) {
  constexpr std::array<const char*, kRules> kNames = {"limits",
                                                      "speed",
                                                      "acceleration",
                                                      "leap",
                                                      "strange goal",
                                                      "motion after stop",
                                                      "torque after stop",
                                                      "torque after contract",
                                                      "linkage"};
  return kNames[static_cast<std::size_t>(rule)];
}

Judge::Judge(const servo::ServoRig& rig, std::vector<Wire> wires) : rig_(rig) {
  const servo::Contract& c = rig.contract;
  contract_ = c.fresh + c.hold + c.ease + c.limp;
  for (const servo::Linkage& rule : rig.linkages) {
    const Duration braking =
        std::max(BrakingTime(rig.servos[rule.yields]), BrakingTime(rig.servos[rule.other]));
    links_.push_back({.told = {}, .seen = {}, .braking = kTwoTicks + braking});
  }
  for (Wire& wire : wires) servos_.emplace_back().wire = std::move(wire);
}

void Judge::Wished(std::size_t servo, Time at) { servos_[servo].wished = at; }

void Judge::Stopped(Time at) {
  if (!stopped_) stopped_ = at;
}

void Judge::Released() { stopped_.reset(); }

void Judge::Unheard(std::size_t servo, Time until) {
  servos_[servo].unheard = std::max(servos_[servo].unheard, until);
}

void Judge::Delayed(Duration by) {
  if (stopped_) *stopped_ += by;
  for (Servo& servo : servos_) {
    if (servo.wished) *servo.wished += by;
  }
}

void Judge::Note(Time at, std::size_t servo, Rule rule, double found, double allowed) {
  if (++counts_[static_cast<std::size_t>(rule)] > kKept) return;
  violations_.push_back({at, servo, rule, found, allowed});
}

std::size_t Judge::Count() const {
  return std::accumulate(counts_.begin(), counts_.end(), std::size_t{0});
}

std::string Judge::Report() const {
  std::string text;
  for (const Violation& v : violations_) {
    std::array<char, 160> line{};
    std::snprintf(line.data(), line.size(), "%10.4f s  servo %zu (%s): %s %.2f, allowed %.2f\n",
                  InSeconds(v.at.time_since_epoch()), v.servo,
                  std::string(rig_.servos[v.servo].name.view()).c_str(), Name(v.rule), v.found,
                  v.allowed);
    text += line.data();
  }
  return text;
}

void Judge::Told(Time at, Duration tick, const servo::Commands& commands) {
  for (std::size_t i = 0; i < servos_.size(); ++i) {
    ToldOne(at, InSeconds(tick), i, commands.servos[i]);
  }
  for (std::size_t i = 0; i < links_.size(); ++i) {
    const servo::Linkage& rule = rig_.linkages[i];
    const servo::Command& yields = commands.servos[rule.yields];
    const servo::Command& other = commands.servos[rule.other];
    Broken& broken = links_[i].told;
    if (!yields.torque || !other.torque) {
      broken = {};
      continue;
    }
    const double by = Excess(rule, yields.position, other.position);
    if (!broken.MayBe(at, by, links_[i].braking)) Note(at, rule.yields, Rule::kLinkage, by, 0);
  }
}

void Judge::ToldOne(Time at, double dt_s, std::size_t i, const servo::Command& command) {
  Servo& servo = servos_[i];
  const servo::Servo& limits = rig_.servos[i];
  const double step = servo.wire.step;
  const bool had_torque = !servo.told.empty() && servo.told.back().torque;
  const double change = had_torque ? command.position - servo.told.back().position : 0;
  servo.told.push_back({at, command.position, command.torque});
  if (servo.told.size() > kRemembered) servo.told.pop_front();
  if (!command.torque) {
    servo.tick_s = 0;
    return;
  }
  if (command.position < limits.min - kRounding || command.position > limits.max + kRounding) {
    Note(at, i, Rule::kLimits, command.position, limits.max);
  }
  if (stopped_ && change != 0) Note(at, i, Rule::kMotionAfterStop, std::abs(change), 0);
  if (stopped_ && rig_.contract.stop_torque == Duration::zero()) {
    Note(at, i, Rule::kTorqueAfterStop, 0, 0);
  }
  if (servo.goal == command.position) servo.agreed = at;
  if (!had_torque) {
    servo.since_change_s = 0;
    return;
  }
  servo.since_change_s += dt_s;
  const double most = limits.max_speed_per_s * dt_s;
  const bool one_step = limits.max_speed_per_s * servo.since_change_s >= step - kRounding;
  if (std::abs(change) > std::max(most, one_step ? step : 0) + kRounding) {
    Note(at, i, Rule::kSpeed, std::abs(change), most);
  }
  const double most_bend = limits.max_acceleration_per_s2 * dt_s * dt_s + 2 * step;
  if (servo.tick_s == dt_s && !stopped_ && limits.max_acceleration_per_s2 > 0 &&
      std::abs(change - servo.change) > most_bend + kRounding) {
    Note(at, i, Rule::kAcceleration, std::abs(change - servo.change), most_bend);
  }
  servo.tick_s = stopped_ ? 0 : dt_s;
  servo.change = change;
  if (change != 0) servo.since_change_s = 0;
}

void Judge::Look(Time at, std::span<const Seen> seen) {
  for (std::size_t i = 0; i < servos_.size(); ++i) LookAtOne(at, i, seen[i]);
  CheckLinkages(at);
}

void Judge::LookAtOne(Time at, std::size_t i, const Seen& seen) {
  Servo& servo = servos_[i];
  if (!seen.torque) {
    servo.was_on = false;
    return;
  }
  ++looks_;
  LookAtTorque(at, i);
  if (!seen.told) {
    servo.was_on = false;
    return;
  }
  const servo::Servo& limits = rig_.servos[i];
  if (seen.goal < limits.min - kRounding || seen.goal > limits.max + kRounding) {
    Note(at, i, Rule::kLimits, seen.goal, limits.max);
  }
  LookAtGoal(at, i, seen);
  // A servo that gives up its path stays where it believes to be.
  const double leap = std::abs(seen.commanded - servo.commanded);
  const double most_leap = servo.wire.own_speed * InSeconds(kLook) + servo.wire.step;
  if (servo.was_on && servo.wire.own_speed > 0 && leap > most_leap &&
      std::abs(seen.commanded - seen.sensed) > 4 * servo.wire.step) {
    Note(at, i, Rule::kLeap, leap, most_leap);
  }
  servo.commanded = seen.commanded;
  servo.was_on = true;
}

void Judge::LookAtGoal(Time at, std::size_t i, const Seen& seen) {
  Servo& servo = servos_[i];
  if (servo.was_on && seen.goal == servo.goal) return;
  const auto word = std::find_if(servo.told.rbegin(), servo.told.rend(), [&](const Word& w) {
    return w.torque && std::abs(w.position - seen.goal) <= servo.wire.step / 2 + kRounding;
  });
  const bool forged = servo.wire.weak_sum && at <= servo.unheard;
  if (word == servo.told.rend() && (forged || seen.goal == servo.wire.home)) {
    forged_ += forged ? 1 : 0;
    servo.agreed.reset();
  } else if (word == servo.told.rend()) {
    Note(at, i, Rule::kStrange, seen.goal, servo.told.empty() ? 0 : servo.told.back().position);
  } else {
    if (servo.was_on && stopped_ && at > *stopped_ + servo.wire.reaction) {
      Note(at, i, Rule::kMotionAfterStop, std::abs(seen.goal - servo.goal), 0);
    }
    // Between two words of one motion it had the time that lies between them. A motion that began
    // anew began where the servo was.
    const bool same_motion =
        servo.was_on && servo.agreed && *servo.agreed <= word->at &&
        std::none_of(servo.told.rbegin(), servo.told.rend(), [&](const Word& w) {
          return w.at > *servo.agreed && w.at <= word->at && !w.torque;
        });
    const double time_s = same_motion ? InSeconds(word->at - *servo.agreed) : 0;
    const double most = rig_.servos[i].max_speed_per_s * time_s + servo.wire.step;
    const double change = std::abs(seen.goal - servo.goal);
    if (same_motion && change > most + kRounding) Note(at, i, Rule::kSpeed, change, most);
    servo.agreed = word->at;
  }
  servo.goal = seen.goal;
}

void Judge::LookAtTorque(Time at, std::size_t i) {
  Servo& servo = servos_[i];
  const Duration obeys = servo.wire.reaction + servo.wire.lets_go + kLook;
  const auto late = [&](Time due) { return InSeconds(at - std::max(due, servo.unheard) - obeys); };
  if (stopped_) {
    const double late_s = late(*stopped_ + rig_.contract.stop_torque);
    if (late_s > 0) Note(at, i, Rule::kTorqueAfterStop, late_s, 0);
  }
  const Time due = servo.wished ? *servo.wished + contract_ + servo.wire.held_back : Time{};
  if (late(due) > 0) Note(at, i, Rule::kTorqueAfterContract, late(due), 0);
}

bool Judge::Broken::MayBe(Time at, double broken, Duration braking) {
  if (!both_on) both_on = at;
  const bool may = broken <= by + kRounding || at - *both_on <= braking;
  by = std::max(0.0, broken);
  return may;
}

// At the buses a rule may be off by what the two servos may move while one of them has not heard
// the newest word.
void Judge::CheckLinkages(Time at) {
  for (std::size_t i = 0; i < links_.size(); ++i) {
    const servo::Linkage& rule = rig_.linkages[i];
    const Servo& yields = servos_[rule.yields];
    const Servo& other = servos_[rule.other];
    Broken& broken = links_[i].seen;
    if (!yields.was_on || !other.was_on || !yields.agreed || !other.agreed) {
      broken = {};
      continue;
    }
    const auto astray = [&](const Servo& servo, std::uint8_t number) {
      return rig_.servos[number].max_speed_per_s * InSeconds(at - *servo.agreed) + servo.wire.step;
    };
    const double allowed =
        astray(yields, rule.yields) + std::abs(double{rule.gain}) * astray(other, rule.other);
    const double by = Excess(rule, yields.goal, other.goal);
    if (!broken.MayBe(at, by, links_[i].braking) && by > allowed + links_[i].told.by) {
      Note(at, rule.yields, Rule::kLinkage, by, allowed);
    }
  }
}

}  // namespace facewire::stage
