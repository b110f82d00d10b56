#ifndef FACEWIRE_CORE_RBF_LANES_H_
#define FACEWIRE_CORE_RBF_LANES_H_

#include <array>
#include <cstddef>
#include <cstring>

namespace facewire::rbf {

// Four floats that the compiler keeps in one vector register (NEON, SSE). Written out because GCC
// neither reorders float sums nor keeps an array of them in registers by itself.
using Lanes = float __attribute__((vector_size(16)));
inline constexpr std::size_t kLanes = 4;
// Samples that are worked on at a time: four registers of sums, so that additions overlap.
inline constexpr std::size_t kBlock = 4 * kLanes;

inline Lanes LoadLanes(const float* from) noexcept {
  Lanes lanes;
  std::memcpy(&lanes, from, sizeof(lanes));
  return lanes;
}

inline void StoreLanes(const Lanes& lanes, float* to) noexcept {
  std::memcpy(to, &lanes, sizeof(lanes));
}

// Squared distances of a block: sums[s] = sum_i (x[i] - centres[i * kBlock + s])^2.
inline void SquaredDistances(const float* x, const float* centres, std::size_t inputs,
                             float* sums) noexcept {
  std::array<Lanes, 4> sum{};
  for (std::size_t i = 0; i < inputs; ++i, centres += kBlock) {
    for (std::size_t r = 0; r < sum.size(); ++r) {
      const Lanes d = x[i] - LoadLanes(centres + r * kLanes);
      sum[r] += d * d;
    }
  }
  for (std::size_t r = 0; r < sum.size(); ++r) StoreLanes(sum[r], sums + r * kLanes);
}

// Sum of a[i] * b[i]; `count` is a multiple of kBlock.
inline float DotProduct(const float* a, const float* b, std::size_t count) noexcept {
  std::array<Lanes, 4> sum{};
  for (std::size_t i = 0; i < count; i += kBlock)
    for (std::size_t r = 0; r < sum.size(); ++r)
      sum[r] += LoadLanes(a + i + r * kLanes) * LoadLanes(b + i + r * kLanes);
  const Lanes total = (sum[0] + sum[1]) + (sum[2] + sum[3]);
  return (total[0] + total[1]) + (total[2] + total[3]);
}

}  // namespace facewire::rbf

#endif  // FACEWIRE_CORE_RBF_LANES_H_
