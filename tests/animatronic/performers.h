#ifndef FACEWIRE_TESTS_ANIMATRONIC_PERFORMERS_H_
#define FACEWIRE_TESTS_ANIMATRONIC_PERFORMERS_H_

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>

#include "tests/sim/random.h"

namespace facewire::stage {

// What a servo is asked for, as a part of its range; the same for the same arguments. Each servo
// has a phase of its own.

// A face that talks, nods and blinks: slow, fast, and with jumps of 60 ms.
inline double Moving(std::size_t servo, double t_s) {
  const double t = t_s + 1.7 * static_cast<double>(servo);
  const double talk = 0.12 * std::sin(2 * std::numbers::pi * 2.3 * t) *
                      std::max(0.0, std::sin(2 * std::numbers::pi * 0.23 * t));
  const double nod = 0.15 * std::sin(2 * std::numbers::pi * 0.4 * t);
  const double phase = std::fmod(t, 3.7);
  const double blink = 0.2 * std::clamp(std::min(phase, 0.3 - phase) / 0.06, 0.0, 1.0);
  return 0.5 + talk + nod + blink;
}

// What a tracker adds to it: white noise and a slow drift.
class Tremble {
 public:
  static constexpr double kWhite = 0.003;  // standard deviation
  static constexpr double kDrift = 0.003;

  explicit Tremble(std::uint64_t seed) : random_(seed) {}
  double operator()(std::size_t servo, double t_s) {
    const double phase = static_cast<double>(servo);
    const double drift = kDrift * std::sin(t_s / 2 + phase) * std::sin(t_s / 3.1);
    return drift + kWhite * Normal();
  }

 private:
  // Box and Muller's.
  double Normal() {
    const double radius = std::sqrt(-2 * std::log(1 - random_.Uniform()));
    return radius * std::cos(2 * std::numbers::pi * random_.Uniform());
  }

  sim::Random random_;
};

}  // namespace facewire::stage

#endif  // FACEWIRE_TESTS_ANIMATRONIC_PERFORMERS_H_
