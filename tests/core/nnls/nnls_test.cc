#include "core/nnls/nnls.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace facewire::nnls {
namespace {

// Three blend shapes that move four coordinates, each alone in one sample after the neutral; the
// second and the third overlap.
struct Context {
  NnlsConfig config;
  NnlsShape shape{4, 4, 3};
  std::vector<float> samples = {1, 1, 1, 1, 3, 1, 1, 1, 1, 2, 1, 1, 1, 1.8F, 1.5F, 1};
  std::vector<float> targets = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
  std::size_t neutral = 0;
  std::vector<float> errors;
  std::vector<std::byte> block, workspace;
  Nnls nnls;
  NnlsReport report;

  Result<> Fit() {
    block.resize(Nnls::RequiredBytes(shape));
    workspace.resize(Nnls::WorkspaceBytes(shape));
    Arena arena(block);
    EXPECT_TRUE(nnls.Reserve(shape, arena));
    errors.resize(targets.size());
    return nnls.Fit(config, shape, samples, targets, neutral, workspace, report, errors);
  }
  std::vector<float> At(const std::vector<float>& x) {
    std::vector<float> y(shape.outputs, -99.0F);
    nnls.Evaluate(x, y);
    return y;
  }
  // The face with these weights.
  std::vector<float> Mixed(float a, float b, float c) const {
    std::vector<float> x(4);
    for (std::size_t i = 0; i < 4; ++i)
      x[i] = samples[i] + a * (samples[4 + i] - samples[i]) + b * (samples[8 + i] - samples[i]) +
             c * (samples[12 + i] - samples[i]);
    return x;
  }
};

TEST(Nnls, FindsTheWeightsOfAnyMixtureOfItsShapes) {
  Context c;
  ASSERT_TRUE(c.Fit());
  for (const float a : {0.0F, 0.3F, 1.0F}) {
    for (const float b : {0.0F, 0.6F, 1.0F}) {
      const auto y = c.At(c.Mixed(a, b, 0.4F));
      EXPECT_NEAR(y[0], a, 1e-3F);
      EXPECT_NEAR(y[1], b, 1e-3F);
      EXPECT_NEAR(y[2], 0.4F, 1e-3F);
    }
  }
}

TEST(Nnls, NeverLeavesTheTrainedRangeAndIsStillTheNearestThere) {
  Context c;
  ASSERT_TRUE(c.Fit());
  const auto least = c.At(c.Mixed(-1, 0.5F, -0.5F));
  EXPECT_EQ(least[0], 0);
  EXPECT_EQ(least[2], 0);
  // Shape 3 alone would pull by -0.5; along shape 2 that is 0.8 of it.
  EXPECT_NEAR(least[1], 0.5F - 0.5F * 0.8F, 1e-3F);
  const auto most = c.At(c.Mixed(9, 0.5F, 0));
  EXPECT_EQ(most[0], 1);
  EXPECT_NEAR(most[1], 0.5F, 1e-3F);
}

TEST(Nnls, TargetsHaveAnyUnitAndAnyNeutral) {
  Context c;
  // The first shape as an angle that goes from -5 to 15 degrees and rests at 5.
  c.targets = {5, 0, 0, 15, 0, 0, 5, 1, 0, 5, 0, 1};
  ASSERT_TRUE(c.Fit());
  EXPECT_NEAR(c.At(c.Mixed(0, 0, 0))[0], 5, 1e-3F);
  EXPECT_NEAR(c.At(c.Mixed(0.5F, 1, 0))[0], 10, 1e-2F);
}

TEST(Nnls, MixedSamplesGiveTheSameBasis) {
  Context c;
  const auto first = c.Mixed(1, 1, 0);
  const auto second = c.Mixed(0, 1, 1);
  c.samples.resize(4);
  for (const auto& x : {first, second, c.Mixed(0.5F, 0, 0.5F), c.Mixed(0.2F, 0.9F, 0.1F)})
    c.samples.insert(c.samples.end(), x.begin(), x.end());
  c.targets = {0, 0, 0, 1, 1, 0, 0, 1, 1, 0.5F, 0, 0.5F, 0.2F, 0.9F, 0.1F};
  c.shape.samples = 5;
  ASSERT_TRUE(c.Fit());
  c.samples = Context{}.samples;
  EXPECT_NEAR(c.At(c.Mixed(0.7F, 0.2F, 0.9F))[1], 0.2F, 1e-3F);
}

TEST(Nnls, LeaveOneOutIsWhatABasisOfTheOthersGives) {
  Context c;
  c.config.ridge = 1e-4F;
  // Shows all three, so that the bounds are the same without any of the others.
  const auto extra = c.Mixed(1, 0.9F, 1);
  c.samples.insert(c.samples.end(), extra.begin(), extra.end());
  c.targets.insert(c.targets.end(), {1, 1, 1});
  c.shape.samples = 5;
  ASSERT_TRUE(c.Fit());
  for (std::size_t left = 1; left < 5; ++left) {
    Context others;
    others.config = c.config;
    others.shape.samples = 4;
    others.samples = c.samples;
    others.targets = c.targets;
    const auto at = static_cast<std::ptrdiff_t>(left);
    others.samples.erase(others.samples.begin() + 4 * at, others.samples.begin() + 4 * at + 4);
    others.targets.erase(others.targets.begin() + 3 * at, others.targets.begin() + 3 * at + 3);
    ASSERT_TRUE(others.Fit());
    const std::vector<float> x(c.samples.begin() + 4 * at, c.samples.begin() + 4 * at + 4);
    const auto y = others.At(x);
    for (std::size_t o = 0; o < 3; ++o)
      EXPECT_NEAR(c.errors[3 * left + o], c.targets[3 * left + o] - y[o], 5e-3F)
          << "without sample " << left << ", output " << o;
  }
}

TEST(Nnls, WithoutRidgeNamesWhatCannotBeTold) {
  Context twice;
  twice.config.ridge = 0;
  std::copy_n(twice.samples.begin() + 4, 4, twice.samples.begin() + 12);
  EXPECT_EQ(twice.Fit().error(), Errc::kSingular);
  EXPECT_EQ(twice.report.duplicate_first, 1U);
  EXPECT_EQ(twice.report.duplicate_second, 3U);
  Context unseen;
  unseen.config.ridge = 0;
  unseen.samples[5] = 1.5F;  // the third sample shows nothing of its own
  for (std::size_t i = 0; i < 4; ++i) unseen.samples[12 + i] = 1 + 2 * (unseen.samples[8 + i] - 1);
  EXPECT_EQ(unseen.Fit().error(), Errc::kSingular);
  EXPECT_EQ(unseen.report.dependent_output, 2U);
}

TEST(Nnls, AnOutputThatMovesNothingRests) {
  Context c;
  std::copy_n(c.samples.begin(), 4, c.samples.begin() + 12);
  ASSERT_TRUE(c.Fit());
  EXPECT_EQ(c.At(c.Mixed(1, 1, 0))[2], 0);
}

TEST(Nnls, WhatIsNotFiniteEndsAndIsNotFinite) {
  Context c;
  ASSERT_TRUE(c.Fit());
  EXPECT_FALSE(std::isfinite(c.At({std::numeric_limits<float>::quiet_NaN(), 1, 1, 1})[0]));
}

TEST(Nnls, RefusesWhatItCannotUse) {
  Context c;
  c.samples[3] = std::numeric_limits<float>::infinity();
  EXPECT_EQ(c.Fit().error(), Errc::kInvalidArgument);
  Context negative;
  negative.config.ridge = -1;
  EXPECT_EQ(negative.Fit().error(), Errc::kInvalidArgument);
  Context small;
  std::vector<std::byte> block(Nnls::RequiredBytes(small.shape) - sizeof(float) * 3);
  Arena arena(block);
  EXPECT_EQ(small.nnls.Reserve(small.shape, arena).error(), Errc::kFull);
}

}  // namespace
}  // namespace facewire::nnls
