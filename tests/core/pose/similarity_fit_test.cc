#include "core/pose/similarity_fit.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "tests/support/generated_face.h"

namespace facewire::pose {
namespace {

using test::Rotation;

std::vector<PointPair> RandomPairs(unsigned seed, std::size_t count) {
  std::mt19937 random(seed);
  std::normal_distribution<float> normal;
  std::vector<PointPair> pairs(count);
  for (PointPair& p : pairs) {
    p.from = {normal(random), normal(random), normal(random)};
    p.weight = 1;
  }
  return pairs;
}

TEST(FitSimilarity, RecoversAKnownOneFromThreePoints) {
  auto pairs = RandomPairs(1, 3);
  const Matrix3 rotation = Rotation(70, -160, 33);
  for (PointPair& p : pairs) p.to = 2.5F * (rotation * p.from) + Point3{1, -2, 30};
  const auto fit = FitSimilarity(pairs);
  ASSERT_TRUE(fit);
  EXPECT_NEAR(fit->scale, 2.5, 1e-4);
  for (std::size_t i = 0; i < 9; ++i) EXPECT_NEAR(fit->rotation[i], rotation[i], 1e-5);
  EXPECT_NEAR(fit->misfit, 0, 1e-3);
  const Point3 centre =
      fit->scale * (fit->rotation * (Point3{} - fit->from_centre)) + fit->to_centre;
  EXPECT_NEAR(centre.x, 1, 1e-4);
  EXPECT_NEAR(centre.y, -2, 1e-4);
  EXPECT_NEAR(centre.z, 30, 1e-4);
}

TEST(FitSimilarity, APointWithoutWeightDoesNotCount) {
  auto pairs = RandomPairs(2, 8);
  for (PointPair& p : pairs) p.to = p.from;
  pairs[3].to = {100, 100, 100};
  pairs[3].weight = 0;
  const auto fit = FitSimilarity(pairs);
  ASSERT_TRUE(fit);
  EXPECT_NEAR(fit->scale, 1, 1e-5);
  EXPECT_NEAR(fit->misfit, 0, 1e-3);
}

TEST(FitSimilarity, NoSmallTurnOrScaleIsBetter) {
  auto pairs = RandomPairs(3, 12);
  std::mt19937 random(4);
  std::normal_distribution<float> normal;
  for (PointPair& p : pairs) {
    p.to = p.from + 0.4F * Point3{normal(random), normal(random), normal(random)};
    p.weight = std::abs(normal(random));
  }
  const auto fit = FitSimilarity(pairs);
  ASSERT_TRUE(fit);
  const auto cost = [&](float scale, const Matrix3& turn) {
    double sum = 0;
    for (const PointPair& p : pairs) {
      const Point3 d =
          scale * (turn * (fit->rotation * (p.from - fit->from_centre))) + fit->to_centre - p.to;
      sum += double{p.weight} * Dot(d, d);
    }
    return sum;
  };
  const double best = cost(fit->scale, kIdentity3);
  for (float step : {-1.F, 1.F}) {
    EXPECT_GT(cost(fit->scale * (1 + 0.01F * step), kIdentity3), best);
    EXPECT_GT(cost(fit->scale, Rotation(step, 0, 0)), best);
    EXPECT_GT(cost(fit->scale, Rotation(0, step, 0)), best);
    EXPECT_GT(cost(fit->scale, Rotation(0, 0, step)), best);
  }
}

TEST(FitSimilarity, AMirroredShapeIsMetWithARotationAndAMisfit) {
  auto pairs = RandomPairs(5, 20);
  for (PointPair& p : pairs) p.to = {-p.from.x, p.from.y, p.from.z};
  const auto fit = FitSimilarity(pairs);
  ASSERT_TRUE(fit);
  EXPECT_GT(fit->misfit, 0.3F);
}

TEST(FitSimilarity, AFlatShapeHasOneRotation) {
  auto pairs = RandomPairs(6, 20);
  const Matrix3 rotation = Rotation(20, 30, 40);
  for (PointPair& p : pairs) {
    p.from.z = 0;
    p.to = rotation * p.from;
  }
  const auto fit = FitSimilarity(pairs);
  ASSERT_TRUE(fit);
  for (std::size_t i = 0; i < 9; ++i) EXPECT_NEAR(fit->rotation[i], rotation[i], 1e-5);
}

TEST(FitSimilarity, WhatLeavesTheRotationOpenIsSingular) {
  EXPECT_EQ(FitSimilarity({}).error(), Errc::kSingular);
  EXPECT_EQ(FitSimilarity(RandomPairs(7, 1)).error(), Errc::kSingular);
  auto two = RandomPairs(8, 2);
  for (PointPair& p : two) p.to = p.from;
  EXPECT_EQ(FitSimilarity(two).error(), Errc::kSingular);
  auto line = RandomPairs(9, 10);
  for (PointPair& p : line) p.to = p.from = p.from.x * Point3{1, 2, 3} + Point3{4, 5, 6};
  EXPECT_EQ(FitSimilarity(line).error(), Errc::kSingular);
  auto weightless = RandomPairs(10, 10);
  for (PointPair& p : weightless) p.weight = 0;
  EXPECT_EQ(FitSimilarity(weightless).error(), Errc::kSingular);
  auto collapsed = RandomPairs(11, 10);
  for (PointPair& p : collapsed) p.to = {1, 2, 3};
  EXPECT_EQ(FitSimilarity(collapsed).error(), Errc::kSingular);
}

}  // namespace
}  // namespace facewire::pose
