#include "core/rbf/system.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/core/rbf/golden.h"
#include "tests/core/rbf/golden_name.h"

namespace facewire::rbf {
namespace {

class SystemGolden : public testing::TestWithParam<golden::Case> {};

TEST_P(SystemGolden, AgreesWithScipyToNineDigits) {
  const golden::Case& expected = GetParam();
  const RbfShape shape{golden::kSamples.size() / 2, 2, 2, expected.tail};
  std::vector<std::byte> workspace(System::WorkspaceBytes(shape));
  System system;
  ASSERT_TRUE(system.Configure(shape, golden::kSamples, golden::kTargets, workspace));
  FitReport report;
  ASSERT_TRUE(system.Solve({.kernel = expected.kernel,
                            .tail = expected.tail,
                            .smoothing = expected.smoothing,
                            .tail_smoothing = expected.tail_smoothing},
                           static_cast<double>(expected.epsilon), report));
  for (std::size_t place = 0; place < golden::kAt.size() / 2; ++place) {
    std::array<double, 2> y{};
    system.Evaluate(std::span(golden::kAt).subspan(2 * place, 2), y);
    for (std::size_t o = 0; o < 2; ++o) {
      const double value = expected.values[2 * place + o];
      EXPECT_NEAR(y[o], value, 1e-9 * std::abs(value));
    }
  }
}

TEST_P(SystemGolden, AtASampleItsEquationSaysWhatTheSumSays) {
  const golden::Case& expected = GetParam();
  const std::size_t samples = golden::kSamples.size() / 2;
  const RbfShape shape{samples, 2, 2, expected.tail};
  std::vector<float> weights(samples, 1.0F);
  weights[1] = 3;
  std::vector<std::byte> workspace(System::WorkspaceBytes(shape));
  System system;
  ASSERT_TRUE(system.Configure(shape, golden::kSamples, golden::kTargets, workspace, weights));
  FitReport report;
  ASSERT_TRUE(system.Solve({.kernel = expected.kernel,
                            .tail = expected.tail,
                            .smoothing = expected.smoothing,
                            .tail_smoothing = expected.tail_smoothing},
                           static_cast<double>(expected.epsilon), report));
  for (std::size_t s = 0; s < samples; ++s) {
    std::array<double, 2> y{};
    system.Evaluate(system.sample(s), y);
    for (std::size_t o = 0; o < 2; ++o) EXPECT_NEAR(system.AtSample(s, o), y[o], 1e-9) << s;
  }
}

INSTANTIATE_TEST_SUITE_P(Scipy, SystemGolden, testing::ValuesIn(golden::kCases), golden::NameOf);

TEST(Phi, IsZeroForAThinPlateAtItsCentre) {
  EXPECT_EQ(Phi(Kernel::kThinPlate, 0), 0);
  EXPECT_EQ(Phi(Kernel::kThinPlate, 1), 0);
  EXPECT_NEAR(Phi(Kernel::kThinPlate, 4), 4 * std::log(2.0), 1e-15);
}

TEST(System, AWorkspaceThatIsTooSmallIsRefused) {
  const RbfShape shape{golden::kSamples.size() / 2, 2, 2, Tail::kLinear};
  std::vector<std::byte> workspace(System::WorkspaceBytes(shape) / 2);
  System system;
  EXPECT_EQ(system.Configure(shape, golden::kSamples, golden::kTargets, workspace).error(),
            Errc::kInvalidArgument);
}

}  // namespace
}  // namespace facewire::rbf
