#include "tools/sheet/canvas.h"

#include <gtest/gtest.h>

#include <array>

namespace facewire::tools {
namespace {

cv::Vec3b At(const cv::Mat& picture, int x, int y) { return picture.at<cv::Vec3b>(y, x); }

TEST(Canvas, HasTheSizeAndBackgroundThatItWasMadeWith) {
  const cv::Mat picture = Canvas(30, 20, cv::Scalar(1, 2, 3)).Finish();
  EXPECT_EQ(picture.size(), cv::Size(30, 20));
  EXPECT_EQ(picture.type(), CV_8UC3);
  EXPECT_EQ(At(picture, 0, 0), cv::Vec3b(1, 2, 3));
}

TEST(Canvas, DrawsWhereAFinishedPictureHasTheCoordinates) {
  Canvas canvas(40, 40, cv::Scalar(0, 0, 0));
  canvas.Box({10, 10, 20, 20}, 0, cv::Scalar(255, 255, 255));
  const cv::Mat picture = canvas.Finish();
  EXPECT_EQ(At(picture, 12, 12), cv::Vec3b(255, 255, 255));
  EXPECT_EQ(At(picture, 28, 28), cv::Vec3b(255, 255, 255));
  EXPECT_EQ(At(picture, 7, 20), cv::Vec3b(0, 0, 0));
  EXPECT_EQ(At(picture, 33, 20), cv::Vec3b(0, 0, 0));
}

TEST(Canvas, MeasuresTextAsItDrawsIt) {
  const double width = Canvas::TextWidth("facewire", 20);
  EXPECT_GT(width, 60);
  Canvas canvas(300, 60, cv::Scalar(0, 0, 0));
  canvas.Text("facewire", {290, 40}, 20, cv::Scalar(255, 255, 255), Align::kRight);
  const cv::Mat picture = canvas.Finish();
  const int left = static_cast<int>(290 - width);
  EXPECT_EQ(cv::countNonZero(picture.colRange(0, left - 3).reshape(1)), 0);
  EXPECT_GT(cv::countNonZero(picture.colRange(left - 3, left + 12).reshape(1)), 0);
}

TEST(Canvas, ClipsWhatIsDrawnBesideIt) {
  Canvas canvas(20, 20, cv::Scalar(0, 0, 0));
  const std::array line{cv::Point2d{-100, 10}, cv::Point2d{100, 10}};
  canvas.Stroke(line, cv::Scalar(255, 255, 255), 2);
  canvas.Disc({500, -500}, 50, cv::Scalar(255, 255, 255));
  EXPECT_EQ(At(canvas.Finish(), 10, 10), cv::Vec3b(255, 255, 255));
}

}  // namespace
}  // namespace facewire::tools
