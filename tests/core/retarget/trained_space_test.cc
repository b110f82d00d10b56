#include "core/retarget/trained_space.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace facewire::retarget {
namespace {

// Two single poses of two inputs each, 1 and 2 long, in five coordinates of which the last never
// moves.
struct Context {
  nnls::NnlsShape shape{3, 5, 2};
  std::vector<float> samples = {0, 0, 0, 0, 0, 0.6F, 0.8F, 0, 0, 0, 0, 0, 1.2F, 1.6F, 0};
  std::vector<float> targets = {0, 0, 1, 0, 0, 1};
  std::vector<std::byte> block, workspace;
  TrainedSpace space;

  Result<> Configure() {
    block.resize(TrainedSpace::RequiredBytes(shape));
    workspace.resize(TrainedSpace::WorkspaceBytes(shape));
    Arena arena(block);
    return space.Configure(shape, samples, targets, 0, arena, workspace);
  }
  std::vector<float> SquaredDistances(const std::vector<float>& x) const {
    std::vector<float> out(shape.samples);
    for (std::size_t s = 0; s < shape.samples; ++s)
      for (std::size_t i = 0; i < shape.inputs; ++i)
        out[s] += std::pow(x[i] - samples[s * shape.inputs + i], 2.0F);
    return out;
  }
  float Novelty(const std::vector<float>& x, const std::vector<float>& outputs) const {
    return space.Novelty(x, outputs, SquaredDistances(x));
  }
};

TEST(TrainedSpace, SamplesAndTheirMixturesAreFamiliar) {
  Context c;
  ASSERT_TRUE(c.Configure());
  EXPECT_LT(c.Novelty({0.6F, 0.8F, 0, 0, 0}, {1, 0}), 0.01F);
  EXPECT_LT(c.Novelty({0.6F, 0.8F, 1.2F, 1.6F, 0}, {1, 1}), 1);
}

TEST(TrainedSpace, MotionThatTheOutputsDoNotExplainIsNew) {
  Context c;
  ASSERT_TRUE(c.Configure());
  // 1 is the typical distance of the samples.
  const std::vector<float> x = {0.6F, 0.8F, 0, 0, 3};
  EXPECT_NEAR(c.space.Novelty(x, std::vector{1.0F, 0.0F}, {}), 3, 1e-3F);
  EXPECT_NEAR(c.space.Novelty(x, std::vector{0.0F, 0.0F}, {}), std::sqrt(10.0F), 1e-3F);
}

TEST(TrainedSpace, WhatTheSamplesThemselvesDoNotExplainIsNotNew) {
  Context c;
  ASSERT_TRUE(c.Configure());
  c.space.Calibrate(std::vector<float>(5, 0.0F), std::vector{0.0F, 1.0F});  // 2 unexplained
  EXPECT_NEAR(
      c.space.Novelty(std::vector{0.0F, 0.0F, 0.0F, 0.0F, 3.0F}, std::vector{0.0F, 0.0F}, {}), 1.5F,
      1e-3F);
}

TEST(TrainedSpace, AGapBetweenSamplesIsNewHoweverWellItIsExplained) {
  Context c;
  ASSERT_TRUE(c.Configure());
  // The loneliest sample is 2 from its nearest; this is 8.
  EXPECT_NEAR(c.Novelty({0, 0, 6, 8, 0}, {0, 5}), 4, 1e-3F);
}

TEST(TrainedSpace, WhatIsNotFiniteIsNoPose) {
  Context c;
  ASSERT_TRUE(c.Configure());
  EXPECT_EQ(c.Novelty({std::numeric_limits<float>::quiet_NaN(), 0, 0, 0, 0}, {0, 0}), 0);
  EXPECT_EQ(c.Novelty({std::numeric_limits<float>::infinity(), 0, 0, 0, 0}, {0, 0}), 0);
}

TEST(TrainedSpace, ASingleSampleGivesNoMeasure) {
  Context c;
  c.shape.samples = 1;
  c.samples.resize(5);
  c.targets.resize(2);
  ASSERT_TRUE(c.Configure());
  EXPECT_EQ(c.Novelty({9, 9, 9, 9, 9}, {0, 0}), 0);
}

TEST(TrainedSpace, EasesToTheSamplesThatAreMostAlike) {
  Context c;
  ASSERT_TRUE(c.Configure());
  const auto distances = c.SquaredDistances({0, 0, 6, 8, 0});
  const auto eased = [&](float novelty) {
    std::vector<float> outputs = {0.5F, 0.25F};
    c.space.Ease(novelty, distances, outputs);
    return outputs;
  };
  EXPECT_EQ(eased(TrainedSpace::kUnfamiliar), (std::vector{0.5F, 0.25F}));
  EXPECT_NEAR(eased(TrainedSpace::kUnfamiliar + 0.01F)[0], 0.5F, 1e-3F) << "without a jump";
  EXPECT_NEAR(eased(3.75F)[0], 0.25F, 0.01F);
  EXPECT_NEAR(eased(TrainedSpace::kUnknown)[0], 0, 1e-3F);
  EXPECT_NEAR(eased(1000)[1], 1, 1e-3F);
}

TEST(TrainedSpace, AnArenaThatIsTooSmallIsFull) {
  Context c;
  c.workspace.resize(TrainedSpace::WorkspaceBytes(c.shape));
  std::vector<std::byte> small(TrainedSpace::RequiredBytes(c.shape) / 2);
  Arena arena(small);
  EXPECT_EQ(c.space.Configure(c.shape, c.samples, c.targets, 0, arena, c.workspace).error(),
            Errc::kFull);
}

}  // namespace
}  // namespace facewire::retarget
