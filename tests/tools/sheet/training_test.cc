#include "tools/sheet/training.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "tools/sheet/head.h"

namespace facewire::tools {
namespace {

using testing::ElementsAre;

// `rows` rows of two markers and the targets jaw_deg (0..20) and blink (0..1); the first row rests.
struct Context {
  std::vector<std::string> signals{"jaw_deg", "blink"};
  std::vector<float> samples, targets, errors;
  TrainingPicture picture;

  explicit Context(std::size_t rows) : errors(2 * rows) {
    for (std::size_t row = 0; row < rows; ++row) {
      const float part =
          static_cast<float>(row) / static_cast<float>(std::max<std::size_t>(rows - 1, 1));
      samples.insert(samples.end(), {0, -5 - 2 * part, 0, 3, 3 - part, 0});
      targets.insert(targets.end(), {20 * part, part});
    }
    picture = {rows, 0, signals, samples, targets, errors};
  }
  cv::Mat Draw(std::vector<std::size_t> shown) {
    return DrawTrainingSheet("a test", picture, shown);
  }
};

// How many pixels are about as orange as an error is drawn.
int Orange(const cv::Mat& sheet) {
  const cv::Scalar near{12, 12, 12};
  cv::Mat mask;
  cv::inRange(sheet, palette::kParameter - near, palette::kParameter + near, mask);
  return cv::countNonZero(mask);
}

TEST(TrainingSheet, TheErrorOfARowCountsEveryTargetInItsOwnRange) {
  Context c(3);
  c.errors = {0, 0, 20, 0, 0, 1};  // each the whole range of its target
  const std::vector<double> errors = RowErrors(c.picture);
  EXPECT_EQ(errors[0], 0);
  EXPECT_NEAR(errors[1], std::sqrt(0.5), 1e-6);
  EXPECT_NEAR(errors[2], errors[1], 1e-6);
}

TEST(TrainingSheet, ChoosesTheFaceAtRestAndTheWorstRows) {
  Context c(6);
  c.picture.neutral_row = 2;
  c.errors = {0, 0, 0, 0.9F, 0, 0, 0, 0.1F, 0, 0.8F, 0, 0};
  EXPECT_THAT(WorstRows(c.picture, 3), ElementsAre(1, 2, 4));
  EXPECT_THAT(WorstRows(c.picture, 1), ElementsAre(2));
  EXPECT_THAT(WorstRows(c.picture, 60), ElementsAre(0, 1, 2, 3, 4, 5));
}

TEST(TrainingSheet, GrowsByALineForEveryThreeCards) {
  Context c(7);
  const int one = c.Draw({0, 1, 2}).rows;
  EXPECT_EQ(c.Draw({0}).rows, one);
  const int two = c.Draw({0, 1, 2, 3}).rows;
  EXPECT_GT(two, one + 200);
  EXPECT_EQ(c.Draw({0, 1, 2, 3, 4, 5, 6}).rows - two, two - one);
  EXPECT_EQ(c.Draw({0}).cols, kSheetWidthPx);
}

TEST(TrainingSheet, AnErrorStandsOutInItsCard) {
  Context c(3);
  const int quiet = Orange(c.Draw({1}));
  c.errors[3] = 0.5F;  // blink of the second row; the bars on top show it, too
  const int with_its_card = Orange(c.Draw({1}));
  const int with_another = Orange(c.Draw({2}));
  EXPECT_GT(with_another, quiet);
  EXPECT_GT(with_its_card, with_another + 50);
}

TEST(TrainingSheet, DrawsTheLargestTrainingAndTheSmallest) {
  Context large(1024);
  EXPECT_EQ(large.Draw(WorstRows(large.picture, 60)).cols, kSheetWidthPx);
  Context small(1);  // no range, no motion
  EXPECT_FALSE(small.Draw({0}).empty());
}

}  // namespace
}  // namespace facewire::tools
