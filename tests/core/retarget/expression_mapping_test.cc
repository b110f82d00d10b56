#include "core/retarget/expression_mapping.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/core/retarget/training_example.h"

namespace facewire::retarget {
namespace {

TEST(ExpressionMapping, GivesTheTargetsOfItsSamplesAndWhatLiesBetween) {
  ExampleMapping m;
  ASSERT_TRUE(m.Configure({}));
  for (const float blink : {0.0F, 0.25F, 0.5F, 1.0F}) {
    for (const float open : {0.0F, 0.5F, 0.75F, 1.0F}) {
      const auto signals = m.At(TrainingExample::Points(blink, open));
      EXPECT_NEAR(signals[0], blink, 0.05F);
      EXPECT_NEAR(signals[1], open, 0.05F);
    }
  }
}

TEST(ExpressionMapping, ABlinkDoesNotReachTheMouthsRegion) {
  ExampleMapping m;
  ASSERT_TRUE(m.Configure({}));
  EXPECT_EQ(m.At(TrainingExample::Points(0, 0.3F))[1], m.At(TrainingExample::Points(1, 0.3F))[1]);
}

TEST(ExpressionMapping, StaysWithinTheRangeOfItsTargetsFarOutside) {
  ExampleMapping m;
  ASSERT_TRUE(m.Configure({}));
  for (const float far : {-1000.0F, -3.0F, 3.0F, 1000.0F}) {
    for (const float signal : m.At(TrainingExample::Points(far, far))) {
      EXPECT_GE(signal, 0);
      EXPECT_LE(signal, 1);
    }
  }
}

TEST(ExpressionMapping, APointThatIsNotFiniteGivesTheNeutralOfItsRegionOnly) {
  TrainingExample example;
  example.neutral_sample = 4;  // blink 0.5, open 0.5
  ExampleMapping m;
  ASSERT_TRUE(m.Configure(example));
  auto points = TrainingExample::Points(1, 1);
  points[0].y = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(m.At(points)[0], 0.5F);
  EXPECT_NEAR(m.At(points)[1], 1, 0.05F);
  points[0].y = std::numeric_limits<float>::infinity();
  EXPECT_EQ(m.At(points)[0], 0.5F);
}

TEST(ExpressionMapping, KnowsWhichLandmarksItReads) {
  ExampleMapping m;
  ASSERT_TRUE(m.Configure({}));
  EXPECT_TRUE(m.mapping.reads_landmarks());
  EXPECT_EQ(m.mapping.point_indices()[0], 386);
  EXPECT_EQ(m.mapping.point_indices()[3], 14);
}

TEST(ExpressionMapping, MarkersOfAFileAreReadInTheirOwnOrder) {
  TrainingExample example;
  for (std::size_t i = 0; i < 4; ++i)
    example.markers[i] =
        TrainingExample::Named("Lid_" + std::string(1, static_cast<char>('a' + i)));
  ExampleMapping m;
  ASSERT_TRUE(m.Configure(example));
  EXPECT_FALSE(m.mapping.reads_landmarks());
  EXPECT_EQ(m.mapping.point_indices()[2], 2);
}

TEST(ExpressionMapping, RefusesLandmarksMixedWithOtherMarkers) {
  TrainingExample example;
  example.markers[1] = TrainingExample::Named("lm478");  // there is no such landmark
  EXPECT_EQ(ExampleMapping{}.Configure(example).error(), Errc::kInvalidArgument);
}

TEST(ExpressionMapping, EverySignalBelongsToExactlyOneRegion) {
  TrainingExample none;
  none.regions.pop_back();
  EXPECT_EQ(ExampleMapping{}.Configure(none).error(), Errc::kInvalidArgument);
  TrainingExample twice;
  TrainingExample::Fill(twice.regions[1].outputs, {0, 1});
  EXPECT_EQ(ExampleMapping{}.Configure(twice).error(), Errc::kInvalidArgument);
}

TEST(ExpressionMapping, WeightsHoldTheSmoothedFunctionAtTheNeutral) {
  TrainingExample example;
  for (RegionConfig& region : example.regions) {
    region.rbf.smoothing = 2;
    region.rbf.tail_smoothing = 50;
  }
  ExampleMapping smooth;
  ASSERT_TRUE(smooth.Configure(example));
  ExampleMapping held;
  example.weights.assign(example.view().sample_count(), 1);
  example.weights[0] = 1000;
  ASSERT_TRUE(held.Configure(example));
  const auto neutral = TrainingExample::Points(0, 0);
  EXPECT_GT(smooth.At(neutral)[0], 0.01F);
  EXPECT_LT(held.At(neutral)[0], 0.1F * smooth.At(neutral)[0]);
}

TEST(ExpressionMapping, RefusesWeightsThatDoNotBelongToTheSamples) {
  TrainingExample example;
  example.weights = {1, 2};
  EXPECT_EQ(ExampleMapping{}.Configure(example).error(), Errc::kInvalidArgument);
  example.weights.assign(example.view().sample_count(), 1);
  example.weights[3] = 0;
  EXPECT_EQ(ExampleMapping{}.Configure(example).error(), Errc::kInvalidArgument);
}

TEST(ExpressionMapping, NamesTheRegionAndTheSamplesThatCoincide) {
  TrainingExample example;
  for (RegionConfig& region : example.regions) region.rbf = {.epsilon = 1};
  TrainingExample::Fill(example.regions[0].points, {0, 1, 2, 3});
  TrainingExample::Fill(example.regions[0].origin, {});
  ExampleMapping m;
  const auto result = m.Configure(example);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error(), Errc::kSingular);
  EXPECT_EQ(m.report.region, 1U) << "the mouth looks the same whatever the lids do";
  EXPECT_EQ(m.report.fit.duplicate_first, 0U);
  EXPECT_EQ(m.report.fit.duplicate_second, 3U);
}

TEST(ExpressionMapping, AllPrincipalAxesGiveTheSameFunctionAsNone) {
  TrainingExample example;
  ExampleMapping plain;
  ASSERT_TRUE(plain.Configure(example));
  for (RegionConfig& region : example.regions)
    region.axes = static_cast<std::uint16_t>(region.inputs());
  ExampleMapping rotated;
  ASSERT_TRUE(rotated.Configure(example));
  const auto points = TrainingExample::Points(0.3F, 0.8F);
  EXPECT_NEAR(plain.At(points)[0], rotated.At(points)[0], 1e-3);
  EXPECT_NEAR(plain.At(points)[1], rotated.At(points)[1], 1e-3);
}

TEST(ExpressionMapping, ARegionMayUseLeastSquares) {
  TrainingExample example;
  for (RegionConfig& region : example.regions) region.method = Method::kNnls;
  example.regions[1].axes = 1;
  std::vector<float> errors(example.targets.size());
  ExampleMapping m;
  ASSERT_TRUE(m.Configure(example, errors));
  EXPECT_NEAR(m.At(TrainingExample::Points(0.3F, 0.8F))[0], 0.3F, 1e-3F);
  EXPECT_NEAR(m.At(TrainingExample::Points(0.3F, 0.8F))[1], 0.8F, 1e-3F);
  EXPECT_EQ(m.At(TrainingExample::Points(-2, 5))[0], 0);
  EXPECT_EQ(m.At(TrainingExample::Points(-2, 5))[1], 1);
  for (const float error : errors) EXPECT_NEAR(error, 0, 1e-3F);
}

TEST(ExpressionMapping, NamesTheTargetThatLeastSquaresCannotTell) {
  TrainingExample example;
  example.regions.resize(1);
  TrainingExample::Fill(example.regions[0].outputs, {0, 1});  // the eye sees no mouth
  example.regions[0].method = Method::kNnls;
  example.regions[0].nnls.ridge = 0;
  ExampleMapping m;
  EXPECT_EQ(m.Configure(example).error(), Errc::kSingular);
  EXPECT_EQ(m.report.nnls.duplicate_first, 0U) << "the eye is the same, the mouth is not";
  EXPECT_EQ(m.report.nnls.duplicate_second, 1U);
}

TEST(ExpressionMapping, ARegionIgnoresTheMotionOfSignalsThatAreNotItsOwn) {
  // A tracker that moves the lips aside, and up a little, whenever the lids close.
  const auto confused = [](float blink, float open) {
    auto points = TrainingExample::Points(blink, open);
    for (const std::size_t lip : {2, 3}) points[lip] = points[lip] + Point3{blink, 0.3F * blink, 0};
    return points;
  };
  TrainingExample example;
  example.samples.clear();
  for (const float blink : {0.0F, 0.5F, 1.0F})
    for (const float open : {0.0F, 0.5F, 1.0F})
      for (const Point3 p : confused(blink, open))
        example.samples.insert(example.samples.end(), {p.x, p.y, p.z});
  RegionConfig& mouth = example.regions[1];
  mouth.axes = 7;
  mouth.rbf.tail = rbf::Tail::kNone;  // which could tell them apart by itself
  const auto moved_by_blink = [&] {
    ExampleMapping m;
    EXPECT_TRUE(m.Configure(example));
    return std::abs(m.At(confused(2, 0.5F))[1] - m.At(confused(0, 0.5F))[1]);
  };
  const float before = moved_by_blink();
  TrainingExample::Fill(mouth.ignores, {0});
  EXPECT_GT(before, 1e-3F);
  EXPECT_LT(moved_by_blink(), 1e-4F) << before << " before";
  ExampleMapping m;
  ASSERT_TRUE(m.Configure(example));
  EXPECT_NEAR(m.At(confused(1, 0.75F))[1], 0.75F, 0.05F);
}

TEST(ExpressionMapping, RefusesADeadZoneWithoutEndAndIgnoringWithoutAxes) {
  ExampleMapping m;
  TrainingExample example;
  example.regions[0].dead_zone = 0.5F;
  EXPECT_EQ(m.Configure(example).error(), Errc::kInvalidArgument);
  example.regions[0].dead_zone = 0;
  TrainingExample::Fill(example.regions[0].ignores, {1});
  EXPECT_EQ(m.Configure(example).error(), Errc::kInvalidArgument);
}

TEST(ExpressionMapping, SaysWhichRegionsAFaceIsNewTo) {
  for (const Method method : {Method::kRbf, Method::kNnls}) {
    TrainingExample example;
    for (RegionConfig& region : example.regions) region.method = method;
    ExampleMapping m;
    ASSERT_TRUE(m.Configure(example));
    std::vector<float> signals(2);
    std::vector<float> novelty(2, 99);
    m.mapping.Evaluate(TrainingExample::Points(0.5F, 0.5F), signals, novelty);
    EXPECT_LT(novelty[0], 1);
    EXPECT_LT(novelty[1], 1);
    auto points = TrainingExample::Points(0.5F, 0.5F);
    points[3].x += 9;  // the lower lip, aside
    m.mapping.Evaluate(points, signals, novelty);
    EXPECT_LT(novelty[0], 1);
    EXPECT_GT(novelty[1], TrainedSpace::kUnfamiliar);
  }
}

TEST(ExpressionMapping, FarOutsideItShowsATrainedPose) {
  TrainingExample example;
  ExampleMapping m;
  ASSERT_TRUE(m.Configure(example));
  auto points = TrainingExample::Points(0.5F, 0.5F);
  points[0].x += 500;
  const float blink = m.At(points)[0];
  EXPECT_NEAR(blink, 0.5F, 0.01F) << "which is the nearest";
}

TEST(ExpressionMapping, LeaveOneOutErrorsComeInTheTargetsPlaces) {
  TrainingExample example;
  std::vector<float> errors(example.targets.size(), 99.0F);
  ExampleMapping m;
  ASSERT_TRUE(m.Configure(example, errors));
  for (const float error : errors) EXPECT_LT(std::abs(error), 0.5F);
}

TEST(ExpressionMapping, AnArenaThatIsTooSmallIsFull) {
  const TrainingExample example;
  std::vector<std::byte> block(64);
  std::vector<std::byte> workspace(ExpressionMapping::WorkspaceBytes(example.view()));
  Arena arena(block);
  ExpressionMapping mapping;
  TrainingReport report;
  EXPECT_EQ(mapping.Configure(example.view(), arena, workspace, report).error(), Errc::kFull);
}

}  // namespace
}  // namespace facewire::retarget
