#include "core/rbf/rbf.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "tests/core/rbf/golden.h"
#include "tests/core/rbf/golden_name.h"

namespace facewire::rbf {
namespace {

// An Rbf with its memory, fitted once.
struct Context {
  RbfConfig config;
  std::vector<float> samples, targets, errors, weights;
  std::size_t inputs = 1, outputs = 1;
  std::vector<std::byte> block, workspace;
  Rbf rbf;
  FitReport report;

  Result<> Fit() {
    const RbfShape shape{samples.size() / inputs, inputs, outputs, config.tail};
    block.resize(Rbf::RequiredBytes(shape));
    workspace.resize(Rbf::WorkspaceBytes(shape));
    Arena arena(block);
    EXPECT_TRUE(rbf.Reserve(shape, arena));
    errors.resize(targets.size());
    return rbf.Fit(config, shape, samples, targets, workspace, report, errors, weights);
  }
  std::vector<float> At(std::vector<float> x) {
    std::vector<float> y(outputs, -99.0F);
    rbf.Evaluate(x, y);
    return y;
  }
};

Context ContextOf(const golden::Case& example) {
  Context c;
  c.config = {example.kernel, example.tail, example.epsilon, example.smoothing,
              example.tail_smoothing};
  c.samples.assign(golden::kSamples.begin(), golden::kSamples.end());
  c.targets.assign(golden::kTargets.begin(), golden::kTargets.end());
  c.inputs = c.outputs = 2;
  return c;
}

class RbfGolden : public testing::TestWithParam<golden::Case> {};

TEST_P(RbfGolden, FloatAgreesWithValuesComputedIndependently) {
  Context c = ContextOf(GetParam());
  ASSERT_TRUE(c.Fit());
  for (std::size_t place = 0; place < golden::kAt.size() / 2; ++place) {
    const auto y = c.At({golden::kAt[2 * place], golden::kAt[2 * place + 1]});
    for (std::size_t o = 0; o < 2; ++o) {
      const double value = GetParam().values[2 * place + o];
      EXPECT_NEAR(y[o], value, 1e-4 * (1 + std::abs(value)));
    }
  }
}

TEST_P(RbfGolden, RippasFormulaEqualsLeavingASampleOut) {
  Context c = ContextOf(GetParam());
  ASSERT_TRUE(c.Fit());
  for (std::size_t o = 0; o < 2; ++o) {
    const double value = GetParam().leave_one_out[o];
    EXPECT_NEAR(c.errors[2 * golden::kLeftOut + o], value, 1e-6 * (1 + std::abs(value)));
  }
}

INSTANTIATE_TEST_SUITE_P(Scipy, RbfGolden, testing::ValuesIn(golden::kCases), golden::NameOf);

TEST(Rbf, TwoSamplesOnALineMatchTheFormulaByHand) {
  // H = [1 p; p 1] with p = sqrt(1 + 1) for r = 1, T = (0, 1): w = (-p, 1) / (1 - p^2) = (p, -1).
  Context c;
  c.config.epsilon = 1;
  c.samples = {0, 1};
  c.targets = {0, 1};
  ASSERT_TRUE(c.Fit());
  const float p = std::sqrt(2.0F);
  EXPECT_NEAR(c.At({3})[0], p * std::sqrt(10.0F) - std::sqrt(5.0F), 1e-5);
}

TEST(Rbf, PassesThroughEverySampleWithoutSmoothing) {
  for (const Kernel kernel :
       {Kernel::kMultiquadric, Kernel::kInverseMultiquadric, Kernel::kGaussian, Kernel::kLinear,
        Kernel::kCubic, Kernel::kThinPlate}) {
    Context c;
    c.config = {.kernel = kernel, .epsilon = 1.5F};
    c.samples = {0, 0, 1, 0, 0, 1, 1, 1, 0.4F, 0.7F};
    c.targets = {1, -2, 3, 0.5F, 0};
    c.inputs = 2;
    ASSERT_TRUE(c.Fit());
    for (std::size_t s = 0; s < 5; ++s)
      EXPECT_NEAR(c.At({c.samples[2 * s], c.samples[2 * s + 1]})[0], c.targets[s], 1e-4);
  }
}

TEST(Rbf, ALinearTailReproducesALinearFunctionEverywhere) {
  Context c;
  c.config = {.tail = Tail::kLinear, .epsilon = 1, .smoothing = 0.3F};
  c.samples = {0, 0, 1, 0, 0, 1, 1, 1, 2, 3};
  c.inputs = 2;
  for (std::size_t s = 0; s < 5; ++s)
    c.targets.push_back(3 + 2 * c.samples[2 * s] - c.samples[2 * s + 1]);
  ASSERT_TRUE(c.Fit());
  EXPECT_NEAR(c.At({10, -7})[0], 30, 1e-3);
}

TEST(Rbf, MoreSmoothingMovesTowardsTheTail) {
  double previous = 0;
  for (const float smoothing : {0.0F, 0.1F, 1.0F, 100.0F}) {
    Context c;
    c.config = {.tail = Tail::kConstant, .epsilon = 1, .smoothing = smoothing};
    c.samples = {0, 1, 2, 3, 4, 5};
    c.targets = {1, -1, 1, -1, 1, -1};
    ASSERT_TRUE(c.Fit());
    const double rest = std::abs(c.At({0})[0] - 1);
    EXPECT_GE(rest, previous - 1e-5);
    previous = rest;
  }
  EXPECT_GT(previous, 0.9);
}

TEST(Rbf, NamesTwoSamplesInTheSamePlace) {
  Context c;
  c.config.epsilon = 1;
  c.samples = {0, 1, 2, 3, 1};
  c.targets = {0, 1, 2, 3, 4};
  const auto result = c.Fit();
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error(), Errc::kSingular);
  EXPECT_EQ(c.report.duplicate_first, 1U);
  EXPECT_EQ(c.report.duplicate_second, 4U);
  EXPECT_EQ(c.At({1})[0], 0) << "after an error the function is zero";
}

TEST(Rbf, SmoothingReconcilesTwoSamplesInTheSamePlace) {
  Context c;
  c.config = {.tail = Tail::kConstant, .epsilon = 1, .smoothing = 0.01F};
  c.samples = {0, 1, 2, 3, 1};
  c.targets = {0, 1, 2, 3, 2};
  ASSERT_TRUE(c.Fit());
  EXPECT_NEAR(c.At({1})[0], 1.5F, 0.1);
}

// Five samples, the last a little beside the first, not the same floats, and with another target.
Context NearDuplicates(float apart) {
  Context c;
  c.config.epsilon = 1;
  c.samples = {0, 0, 1, 0, 0, 1, 1, 1, apart, 0};
  c.targets = {0, 1, 2, 3, 1};
  c.inputs = 2;
  return c;
}

TEST(Rbf, NamesTwoSamplesThatAreTooNearEachOtherToTellApart) {
  for (const float apart : {1e-9F, 1e-7F, 1e-5F}) {
    for (const Kernel kernel :
         {Kernel::kMultiquadric, Kernel::kInverseMultiquadric, Kernel::kGaussian, Kernel::kLinear,
          Kernel::kCubic, Kernel::kThinPlate}) {
      // Its kink tells samples apart that are flat to the others.
      if (kernel == Kernel::kLinear && apart > 1e-6F) continue;
      SCOPED_TRACE(testing::Message() << apart << ", kernel " << static_cast<int>(kernel));
      Context c = NearDuplicates(apart);
      c.config.kernel = kernel;
      const auto result = c.Fit();
      ASSERT_FALSE(result);
      EXPECT_EQ(result.error(), Errc::kSingular);
      EXPECT_EQ(c.report.duplicate_first, 0U);
      EXPECT_EQ(c.report.duplicate_second, 4U);
    }
  }
}

TEST(Rbf, PointsThatTouchAndPullApartAreSolvedWithALittleSmoothing) {
  // As lips in a neutral: pairs of points 0.1 mm apart that belong 3 mm apart.
  Context c;
  c.config = {.tail = Tail::kLinear, .epsilon = 0.4F, .smoothing = 0.001F, .tail_smoothing = 0.01F};
  c.inputs = 3;
  for (int i = 0; i < 50; ++i) {
    const auto x = static_cast<float>(i % 7);
    const auto y = static_cast<float>(i / 7);
    c.samples.insert(c.samples.end(), {x, y, std::sin(x + y), x, y - 0.01F, std::sin(x + y)});
    c.targets.insert(c.targets.end(), {0.15F, -0.15F});
  }
  EXPECT_TRUE(c.Fit());
}

TEST(Rbf, AutomaticEpsilonDoesNotHideNearDuplicates) {
  Context c = NearDuplicates(1e-9F);
  c.config.epsilon = kAutomaticEpsilon;
  ASSERT_FALSE(c.Fit());
  EXPECT_EQ(c.report.duplicate_second, 4U);
}

TEST(Rbf, SmoothingReconcilesSamplesThatNearlyTouch) {
  Context c = NearDuplicates(1e-5F);
  c.config.smoothing = 0.01F;
  ASSERT_TRUE(c.Fit());
  EXPECT_NEAR(c.At({0, 0})[0], 0.5F, 0.1);
}

TEST(Rbf, NamesTheSampleThatBecomesDependentWhenTheKernelIsTooFlat) {
  Context c;
  c.config = {.kernel = Kernel::kGaussian, .epsilon = 1e-4F};
  for (int i = 0; i < 8; ++i) {
    c.samples.push_back(static_cast<float>(i));
    c.targets.push_back(0);
  }
  const auto result = c.Fit();
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error(), Errc::kSingular);
  EXPECT_TRUE(c.report.dependent_sample.has_value());
}

TEST(Rbf, SaysWhenTheSamplesDoNotDetermineTheTail) {
  Context c;
  c.config = {.tail = Tail::kLinear, .epsilon = 1};
  c.samples = {0, 0, 1, 1, 2, 2, 3, 3};  // all on one line
  c.targets = {0, 1, 2, 3};
  c.inputs = 2;
  const auto result = c.Fit();
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error(), Errc::kSingular);
  EXPECT_TRUE(c.report.tail_undetermined);
}

TEST(Rbf, RefusesNumbersThatAreNotFiniteAndNegativeSettings) {
  Context c;
  c.config.epsilon = 1;
  c.samples = {0, std::numeric_limits<float>::quiet_NaN()};
  c.targets = {0, 1};
  EXPECT_EQ(c.Fit().error(), Errc::kInvalidArgument);
  c.samples = {0, 1};
  c.config.smoothing = -1;
  EXPECT_EQ(c.Fit().error(), Errc::kInvalidArgument);
}

TEST(Rbf, AnArenaOneByteTooSmallIsFullAndAMoreThanReservedShapeToo) {
  const RbfShape shape{10, 3, 2, Tail::kConstant};
  std::vector<std::byte> block(Rbf::RequiredBytes(shape) / 2);
  Arena small(block);
  Rbf rbf;
  EXPECT_EQ(rbf.Reserve(shape, small).error(), Errc::kFull);
  block.resize(Rbf::RequiredBytes(shape));
  Arena arena(block);
  ASSERT_TRUE(rbf.Reserve(shape, arena));
  RbfShape larger = shape;
  larger.samples = 11;
  FitReport report;
  EXPECT_EQ(rbf.Fit({}, larger, {}, {}, {}, report).error(), Errc::kFull);
}

TEST(Rbf, RequiredBytesAreEnoughForAnyAlignmentOfTheBlock) {
  const RbfShape shape{10, 3, 2, Tail::kLinear};
  std::vector<std::byte> block(Rbf::RequiredBytes(shape) + 1);
  Arena arena(std::span<std::byte>(block).subspan(1));
  Rbf rbf;
  EXPECT_TRUE(rbf.Reserve(shape, arena));
}

TEST(Rbf, TheChosenEpsilonIsNotWorseThanItsNeighboursByLeaveOneOut) {
  Context c;
  for (int i = 0; i < 15; ++i) {
    const float x = static_cast<float>(i) / 14;
    c.samples.push_back(x);
    c.targets.push_back(std::exp(-200 * (x - 0.4F) * (x - 0.4F)));
  }
  const auto error_at = [&](float epsilon) {
    c.config.epsilon = epsilon;
    EXPECT_TRUE(c.Fit());
    double sum = 0;
    for (const float e : c.errors) sum += static_cast<double>(e) * e;
    return sum;
  };
  const double automatic = error_at(0);
  const float chosen = c.report.epsilon;
  EXPECT_LE(automatic, error_at(chosen * 1.5F));
  EXPECT_LE(automatic, error_at(chosen / 1.5F));
}

TEST(Rbf, AutomaticEpsilonIsNeverAFunctionThatFloatCannotCarry) {
  // A smooth function: the flatter the kernel, the less its leave-one-out error, until nothing but
  // rounding is left. The search has to stop before that, wherever its range ends.
  for (const Kernel kernel :
       {Kernel::kMultiquadric, Kernel::kInverseMultiquadric, Kernel::kGaussian}) {
    Context c;
    c.config.kernel = kernel;
    for (int i = 0; i < 12; ++i) {
      c.samples.push_back(static_cast<float>(i) / 11);
      c.targets.push_back(c.samples.back() * c.samples.back());
    }
    ASSERT_TRUE(c.Fit()) << static_cast<int>(kernel);
    for (std::size_t s = 0; s < c.samples.size(); ++s)
      EXPECT_NEAR(c.At({c.samples[s]})[0], c.targets[s], 1e-3);
    EXPECT_NEAR(c.At({0.48F})[0], 0.48F * 0.48F, 1e-2);
  }
}

TEST(Rbf, MeanDistanceIsTheMeanOverAllPairsOfSamples) {
  Context c = ContextOf(golden::kCases[0]);
  c.config.epsilon = kMeanDistanceEpsilon;
  ASSERT_TRUE(c.Fit());
  EXPECT_NEAR(c.report.epsilon, 1 / golden::kMeanDistance, 1e-6);
}

TEST(Rbf, EpsilonOnlyRescalesAThinPlateWithALinearTail) {
  Context c = ContextOf(golden::kCases[0]);
  c.config = {.kernel = Kernel::kThinPlate, .tail = Tail::kLinear, .epsilon = 0.5F};
  ASSERT_TRUE(c.Fit());
  const float narrow = c.At({0.3F, 0.4F})[0];
  c.config.epsilon = 2;
  ASSERT_TRUE(c.Fit());
  EXPECT_NEAR(c.At({0.3F, 0.4F})[0], narrow, 1e-5);
}

TEST(Rbf, AThinPlateIsFlatAtItsOwnSample) {
  Context c = ContextOf(golden::kCases[0]);
  c.config = {.kernel = Kernel::kThinPlate, .tail = Tail::kLinear, .epsilon = 1};
  ASSERT_TRUE(c.Fit());
  for (const float step : {0.0F, 1e-30F, 1e-12F, 1e-6F})
    EXPECT_NEAR(c.At({c.samples[0] + step, c.samples[1]})[0], c.targets[0], 1e-4) << step;
}

TEST(Rbf, FitsAgainInTheSameMemoryWithFewerSamples) {
  Context c;
  c.config.epsilon = 1;
  c.samples = {0, 1, 2, 3};
  c.targets = {0, 1, 2, 3};
  ASSERT_TRUE(c.Fit());
  const RbfShape fewer{2, 1, 1, Tail::kNone};
  const std::vector<float> samples = {5, 6};
  const std::vector<float> targets = {7, 8};
  ASSERT_TRUE(c.rbf.Fit(c.config, fewer, samples, targets, c.workspace, c.report));
  EXPECT_NEAR(c.At({5})[0], 7, 1e-4);
  EXPECT_NEAR(c.At({6})[0], 8, 1e-4);
}

TEST(Rbf, ASampleOfWeightTwoIsTheSampleTwice) {
  Context twice;
  twice.config = {.tail = Tail::kLinear, .epsilon = 1, .smoothing = 0.5F, .tail_smoothing = 0.1F};
  twice.samples = {0, 1, 3, 1};
  twice.targets = {0, 2, 1, 2};
  ASSERT_TRUE(twice.Fit());
  Context once = twice;
  once.samples.pop_back();
  once.targets.pop_back();
  once.weights = {1, 2, 1};
  ASSERT_TRUE(once.Fit());
  for (const float x : {-1.0F, 0.5F, 1.0F, 2.5F})
    EXPECT_NEAR(once.At({x})[0], twice.At({x})[0], 1e-5);
}

TEST(Rbf, ALargeWeightHoldsTheFunctionAtItsSample) {
  Context c;
  c.config = {.epsilon = 1, .smoothing = 1};
  c.samples = {0, 1, 2};
  c.targets = {0, 1, 0};
  ASSERT_TRUE(c.Fit());
  EXPECT_GT(std::abs(c.At({0})[0]), 0.1F);
  c.weights = {1000, 1, 1};
  ASSERT_TRUE(c.Fit());
  EXPECT_NEAR(c.At({0})[0], 0, 1e-2);
}

TEST(Rbf, WeightsHaveToBePositiveAndOneForEachSample) {
  Context c;
  c.config = {.epsilon = 1, .smoothing = 1};
  c.samples = {0, 1};
  c.targets = {0, 1};
  for (const std::vector<float>& weights :
       {std::vector<float>{1}, {1, 0}, {1, -1}, {1, std::numeric_limits<float>::quiet_NaN()}}) {
    c.weights = weights;
    EXPECT_EQ(c.Fit().error(), Errc::kInvalidArgument);
  }
}

}  // namespace
}  // namespace facewire::rbf
