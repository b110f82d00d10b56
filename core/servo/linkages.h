#ifndef FACEWIRE_CORE_SERVO_LINKAGES_H_
#define FACEWIRE_CORE_SERVO_LINKAGES_H_

#include <cstddef>
#include <span>

#include "core/base/capacity.h"
#include "core/base/inline_vector.h"
#include "core/servo/axis.h"
#include "core/servo/servo_rig.h"

namespace facewire::servo {

// Keeps the rules between servos, in every tick and while braking.
//
// For a rule  yields >= gain * other + offset  let reach(x) be the span of positions that x cannot
// avoid any more. A servo may move within the room that the reach of all its partners leaves, and
// its motion always stops within its room; so after its move the rule holds for every pair out of
// the two reaches. Servos move one after the other, each against the present reach of the others,
// so every move keeps every rule; no pair can trap itself, because the place where a servo would
// stop is always in its room. Commands differ from motions by half a step at most, and rules are
// kept with that much to spare.
class Linkages {
 public:
  // The rig must have passed FindFlaw, the axes be configured; both in the order of its servos.
  void Configure(const ServoRig& rig, std::span<const Axis> axes) noexcept;

  // Where `servo` should go so that the others can reach their goals: goals[servo], or what makes
  // way for them.
  double GiveWay(std::size_t servo, std::span<const double> goals) const noexcept;
  // Where it may be. Empty (low > high) only before the rules held for the first time.
  Span Room(std::size_t servo, std::span<const Axis> axes) const noexcept;
  // The order in which servos move: those that yield come first.
  std::span<const std::size_t> order() const noexcept { return order_.span(); }

 private:
  struct Rule {  // side * (position(yields) - gain * position(other)) >= bound
    std::size_t yields = 0;
    std::size_t other = 0;
    double side = 1;
    double gain = 1;
    double bound = 0;
  };
  InlineVector<Rule, kMaxLinkages> rules_;
  InlineVector<std::size_t, kMaxServos> order_;
};

}  // namespace facewire::servo

#endif  // FACEWIRE_CORE_SERVO_LINKAGES_H_
