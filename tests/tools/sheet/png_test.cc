#include "tools/sheet/png.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

namespace facewire::tools {
namespace {

// What another program makes of the file, whose checksums it verifies.
cv::Mat Decoded(const std::string& png) {
  return cv::imdecode(std::vector<char>(png.begin(), png.end()), cv::IMREAD_UNCHANGED);
}

bool Same(const cv::Mat& a, const cv::Mat& b) {
  return a.size() == b.size() && a.type() == b.type() && cv::norm(a, b, cv::NORM_INF) == 0;
}

cv::Mat Noise(int width, int height) {
  cv::Mat picture(height, width, CV_8UC3);
  cv::RNG(7).fill(picture, cv::RNG::UNIFORM, 0, 256);
  return picture;
}

TEST(Png, IsReadBackByteForByte) {
  for (const cv::Size size : {cv::Size{1, 1}, {1, 9}, {9, 1}, {64, 48}, {301, 203}}) {
    const cv::Mat picture = Noise(size.width, size.height);
    EXPECT_TRUE(Same(Decoded(EncodePng(picture)), picture)) << size;
  }
}

TEST(Png, TakesAPartOfALargerPicture) {
  const cv::Mat part = Noise(64, 48)(cv::Rect(5, 7, 20, 10));
  EXPECT_TRUE(Same(Decoded(EncodePng(part)), part));
}

TEST(Png, ADrawingTakesLittle) {
  cv::Mat drawing(800, 600, CV_8UC3, cv::Scalar(239, 244, 246));
  drawing(cv::Rect(50, 50, 300, 200)).setTo(cv::Scalar(10, 20, 30));
  EXPECT_LT(EncodePng(drawing).size(), 10'000U);  // of 1.4 million bytes
}

}  // namespace
}  // namespace facewire::tools
