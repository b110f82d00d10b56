#include "core/servo/linkages.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace facewire::servo {
namespace {

// Of a step, besides the half: for the last bits.
constexpr double kSpare = 1e-6;

// position * factor >= bound, as limits of the position.
void Narrow(Span& room, double factor, double bound) noexcept {
  if (factor > 0) room.low = std::max(room.low, bound / factor);
  if (factor < 0) room.high = std::min(room.high, bound / factor);
}

// The least value of factor * x for x in the span.
double Least(double factor, const Span& x) noexcept {
  return std::min(factor * x.low, factor * x.high);
}

}  // namespace

void Linkages::Configure(const ServoRig& rig, std::span<const Axis> axes) noexcept {
  rules_.clear();
  for (const Linkage& from : rig.linkages) {
    const double side = from.relation == Relation::kAtLeast ? 1 : -1;
    const double gain = from.gain;
    const double spare =
        (0.5 + kSpare) * (axes[from.yields].step() + std::abs(gain) * axes[from.other].step());
    (void)rules_.try_push({from.yields, from.other, side, gain, side * from.offset + spare});
  }
  order_.clear();
  for (const bool first : {true, false}) {
    for (std::size_t i = 0; i < rig.servos.size(); ++i) {
      const bool yields =
          std::ranges::any_of(rules_, [i](const Rule& rule) { return rule.yields == i; });
      if (yields == first) (void)order_.try_push(i);
    }
  }
}

double Linkages::GiveWay(std::size_t servo, std::span<const double> goals) const noexcept {
  constexpr double kFar = std::numeric_limits<double>::max();
  Span wanted{-kFar, kFar};
  for (const Rule& rule : rules_) {
    if (rule.yields != servo) continue;
    Narrow(wanted, rule.side, rule.bound + rule.side * rule.gain * goals[rule.other]);
  }
  return std::max(std::min(goals[servo], wanted.high), wanted.low);
}

Span Linkages::Room(std::size_t servo, std::span<const Axis> axes) const noexcept {
  constexpr double kFar = std::numeric_limits<double>::max();
  Span room{-kFar, kFar};
  for (const Rule& rule : rules_) {
    const double other = -rule.side * rule.gain;  // its factor in the rule
    if (rule.yields == servo) {
      Narrow(room, rule.side, rule.bound - Least(other, axes[rule.other].reach()));
    } else if (rule.other == servo) {
      Narrow(room, other, rule.bound - Least(rule.side, axes[rule.yields].reach()));
    }
  }
  return room;
}

}  // namespace facewire::servo
