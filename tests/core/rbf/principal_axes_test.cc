#include "core/rbf/principal_axes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace facewire::rbf {
namespace {

std::vector<float> Axes(std::span<const float> samples, std::size_t inputs, std::size_t axes) {
  std::vector<float> basis(axes * inputs);
  std::vector<std::byte> workspace(PrincipalAxesWorkspaceBytes(inputs, axes));
  EXPECT_TRUE(PrincipalAxes(samples, inputs, axes, basis, workspace));
  return basis;
}

float DotOf(const std::vector<float>& basis, std::size_t inputs, std::size_t a, std::size_t b) {
  float sum = 0;
  for (std::size_t i = 0; i < inputs; ++i) sum += basis[a * inputs + i] * basis[b * inputs + i];
  return sum;
}

TEST(PrincipalAxes, FindsTheDirectionOfALineOfSamples) {
  std::vector<float> samples;
  for (int i = -5; i <= 5; ++i) {
    const auto t = static_cast<float>(i);
    samples.insert(samples.end(), {1 + 3 * t, 2 + 4 * t, 7});
  }
  const std::vector<float> basis = Axes(samples, 3, 1);
  EXPECT_NEAR(std::abs(basis[0]), 0.6F, 1e-6);
  EXPECT_NEAR(std::abs(basis[1]), 0.8F, 1e-6);
  EXPECT_NEAR(basis[2], 0, 1e-6);
}

TEST(PrincipalAxes, FindsTheOnlyCoordinateThatMovesWhereverItIs) {
  for (std::size_t moving = 0; moving < 5; ++moving) {
    std::vector<float> samples(15);
    for (std::size_t s = 0; s < 3; ++s) samples[5 * s + moving] = static_cast<float>(s);
    for (const std::size_t axes : {1, 2}) {
      const std::vector<float> basis = Axes(samples, 5, axes);
      float found = 0;
      for (std::size_t a = 0; a < axes; ++a) found += std::abs(basis[5 * a + moving]);
      EXPECT_NEAR(found, 1, 1e-6) << "coordinate " << moving << ", axes " << axes;
    }
  }
}

TEST(PrincipalAxes, AllAxesKeepEveryDistance) {
  std::vector<float> samples;
  for (int i = 0; i < 40; ++i) samples.push_back(std::sin(static_cast<float>(i * i)));
  const std::vector<float> basis = Axes(samples, 4, 4);
  for (std::size_t a = 0; a < 4; ++a)
    for (std::size_t b = 0; b < 4; ++b) EXPECT_NEAR(DotOf(basis, 4, a, b), a == b ? 1 : 0, 1e-6);
}

TEST(PrincipalAxes, SamplesWithoutAnyMotionStillGiveAnOrthonormalBasis) {
  const std::vector<float> samples = {1, 2, 3, 1, 2, 3};
  const std::vector<float> basis = Axes(samples, 3, 2);
  EXPECT_NEAR(DotOf(basis, 3, 0, 0), 1, 1e-6);
  EXPECT_NEAR(DotOf(basis, 3, 1, 1), 1, 1e-6);
  EXPECT_NEAR(DotOf(basis, 3, 0, 1), 0, 1e-6);
}

TEST(PrincipalAxes, RefusesMoreAxesThanInputs) {
  const std::vector<float> samples = {1, 2};
  std::vector<float> basis(6);
  std::vector<std::byte> workspace(PrincipalAxesWorkspaceBytes(2, 3));
  const auto result = PrincipalAxes(samples, 2, 3, basis, workspace);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error(), Errc::kInvalidArgument);
}

}  // namespace
}  // namespace facewire::rbf
