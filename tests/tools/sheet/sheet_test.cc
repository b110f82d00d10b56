#include "tools/sheet/sheet.h"

#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "tests/tools/sheet/rigs.h"

namespace facewire::tools {
namespace {

Moment MakeMoment(const Rig& rig) {
  Moment moment;
  moment.caption = "mouth open";
  moment.picture = cv::Mat(288, 360, CV_8UC3, cv::Scalar(200, 100, 0));
  moment.pose = rig.NeutralPose();
  return moment;
}

// The share of pixels that are not plain paper or card.
double Drawn(const cv::Mat& sheet) {
  cv::Mat grey;
  cv::extractChannel(sheet, grey, 2);
  return cv::countNonZero(grey < 230) / static_cast<double>(grey.total());
}

TEST(Sheet, IsAsWideAsSaidAndGrowsWithItsMoments) {
  const Rig rig = BoneRig();
  const std::vector<Moment> moments(3, MakeMoment(rig));
  const std::array figures{Figure{"480", "frames"}, Figure{"24.0", "frames a second"}};
  const cv::Mat none = DrawSheet("t", figures, rig, {});
  const cv::Mat three = DrawSheet("t", figures, rig, moments);
  EXPECT_EQ(none.cols, kSheetWidthPx);
  EXPECT_EQ(three.cols, kSheetWidthPx);
  EXPECT_GT(three.rows, none.rows + 3 * 300);
  EXPECT_GT(Drawn(three), 0.2);
}

TEST(Sheet, ShowsThePoseOfTheCharacter) {
  const Rig rig = BoneRig();
  std::vector<Moment> moments{MakeMoment(rig)};
  const cv::Mat shut = DrawSheet("t", {}, rig, moments);
  Set(rig, moments[0].pose, "jaw.pitch", 24);
  const cv::Mat open = DrawSheet("t", {}, rig, moments);
  cv::Mat difference;
  cv::absdiff(shut, open, difference);
  EXPECT_GT(cv::countNonZero(difference.reshape(1)), 500);
}

TEST(Sheet, CopesWithFacesAtTheEdgePicturesOfAnyShapeAndNoPicture) {
  const Rig rig = BoneRig();
  std::vector<Moment> moments(3, MakeMoment(rig));
  moments[0].picture = cv::Mat();
  moments[1].picture = cv::Mat(640, 40, CV_8UC3, cv::Scalar(0, 0, 0));
  moments[2].landmarks.count = kMaxLandmarks;
  for (std::size_t i = 0; i < kMaxLandmarks; ++i) {
    moments[2].landmarks.points_px[i] = {static_cast<float>(i % 50) - 40,
                                         static_cast<float>(i / 10) - 20, 0};
  }
  EXPECT_EQ(DrawSheet("t", {}, rig, moments).cols, kSheetWidthPx);
}

TEST(Sheet, CopesWithMoreChannelsAndFiguresThanItShows) {
  Rig rig;
  for (int i = 0; i < 60; ++i)
    AddChannel(rig, "parameter_with_a_long_name_" + std::to_string(i), ChannelKind::kParameter, 0,
               1);
  const std::vector<Moment> moments{MakeMoment(rig)};
  const std::vector<Figure> figures(20,
                                    Figure{"12345678", "a label that is too long for its place"});
  EXPECT_EQ(DrawSheet("t", figures, rig, moments).cols, kSheetWidthPx);
}

}  // namespace
}  // namespace facewire::tools
