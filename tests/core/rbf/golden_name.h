#ifndef FACEWIRE_TESTS_CORE_RBF_GOLDEN_NAME_H_
#define FACEWIRE_TESTS_CORE_RBF_GOLDEN_NAME_H_

#include <gtest/gtest.h>

#include <array>
#include <string>

#include "tests/core/rbf/golden.h"

namespace facewire::rbf::golden {

// "ThinPlateWithLinearTailSmoothedByRBFInterpolator"
inline std::string NameOf(const testing::TestParamInfo<Case>& info) {
  constexpr std::array<const char*, kKernelCount> kKernels = {
      "Multiquadric", "InverseMultiquadric", "Gaussian", "Linear", "Cubic", "ThinPlate"};
  constexpr std::array<const char*, kTailCount> kTails = {"No", "Constant", "Linear"};
  const Case& c = info.param;
  return std::string(kKernels[static_cast<std::size_t>(c.kernel)]) + "With" +
         kTails[static_cast<std::size_t>(c.tail)] + "Tail" +
         (c.smoothing > 0 ? "Smoothed" : "Exact") + (c.tail_smoothing > 0 ? "TailDamped" : "") +
         "By" + std::string(c.source);
}

}  // namespace facewire::rbf::golden

#endif  // FACEWIRE_TESTS_CORE_RBF_GOLDEN_NAME_H_
