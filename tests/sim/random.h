#ifndef FACEWIRE_TESTS_SIM_RANDOM_H_
#define FACEWIRE_TESTS_SIM_RANDOM_H_

#include <cstdint>

namespace facewire::sim {

// The same numbers from the same seed on every machine, which <random>'s distributions do not
// promise (the generator is Steele, Lea and Flood's splitmix64).
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  std::uint64_t Next() {
    std::uint64_t z = (state_ += 0x9E3779B97F4A7C15U);
    z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9U;
    z = (z ^ (z >> 27U)) * 0x94D049BB133111EBU;
    return z ^ (z >> 31U);
  }
  // In [0, 1).
  double Uniform() { return static_cast<double>(Next() >> 11U) * 0x1p-53; }
  double Between(double low, double high) { return low + (high - low) * Uniform(); }
  bool Chance(double probability) { return probability > 0 && Uniform() < probability; }
  std::uint8_t Byte() { return static_cast<std::uint8_t>(Next() >> 56U); }

 private:
  std::uint64_t state_;
};

}  // namespace facewire::sim

#endif  // FACEWIRE_TESTS_SIM_RANDOM_H_
