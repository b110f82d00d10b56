#include "core/track/crop.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <tuple>
#include <vector>

#include "tests/support/footage.h"

namespace facewire::track {
namespace {

using test::Picture;

constexpr std::array kFormats = {PixelFormat::kGrey8, PixelFormat::kYuyv,  PixelFormat::kNv12,
                                 PixelFormat::kI420,  PixelFormat::kRgb24, PixelFormat::kBgr24};

Picture Noise(PixelFormat format, int width, int height, int padding, YuvEncoding encoding) {
  Picture bgr(PixelFormat::kBgr24, width, height);
  std::mt19937 random(static_cast<unsigned>(width * 1000 + height));
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < 3 * width; ++x) bgr.row(0, y)[x] = static_cast<std::uint8_t>(random());
  }
  return bgr.As(format, padding, encoding);
}

// The plain way, one pixel after the other, in double precision: what the crop has to equal.
class Reference {
 public:
  explicit Reference(const ImageView& image) : image_(image) {}

  // R, G, B 0..255 at a point of the picture.
  std::array<double, 3> At(double x_px, double y_px) const {
    const double x = std::clamp(x_px - 0.5, 0.0, image_.width_px - 1.0);
    const double y = std::clamp(y_px - 0.5, 0.0, image_.height_px - 1.0);
    const int x0 = static_cast<int>(x);
    const int y0 = static_cast<int>(y);
    const int x1 = std::min(x0 + 1, image_.width_px - 1);
    const int y1 = std::min(y0 + 1, image_.height_px - 1);
    std::array<double, 3> v{};
    for (int c = 0; c < 3; ++c) {
      const double upper = std::lerp(Channel(x0, y0, c), Channel(x1, y0, c), x - x0);
      const double lower = std::lerp(Channel(x0, y1, c), Channel(x1, y1, c), x - x0);
      v[c] = std::lerp(upper, lower, y - y0);
    }
    return IsYuv() ? ToRgb(v) : v;
  }

 private:
  bool IsYuv() const {
    return image_.format == PixelFormat::kYuyv || image_.format == PixelFormat::kNv12 ||
           image_.format == PixelFormat::kI420;
  }
  double Byte(int plane, int y, int at) const {
    return image_.planes[plane].data[y * image_.planes[plane].stride_bytes + at];
  }
  // R, G, B or Y, U, V of a pixel.
  double Channel(int x, int y, int c) const {
    switch (image_.format) {
      case PixelFormat::kGrey8:
        return Byte(0, y, x);
      case PixelFormat::kRgb24:
        return Byte(0, y, 3 * x + c);
      case PixelFormat::kBgr24:
        return Byte(0, y, 3 * x + 2 - c);
      case PixelFormat::kYuyv:
        return Byte(0, y, c == 0 ? 2 * x : 4 * (x / 2) + 2 * c - 1);
      case PixelFormat::kNv12:
        return c == 0 ? Byte(0, y, x) : Byte(1, y / 2, 2 * (x / 2) + c - 1);
      case PixelFormat::kI420:
        return c == 0 ? Byte(0, y, x) : Byte(c, y / 2, x / 2);
    }
    return 0;
  }
  // From the definition of BT.601: luma weights 0.299 and 0.114.
  std::array<double, 3> ToRgb(std::array<double, 3> yuv) const {
    const bool full = image_.encoding == YuvEncoding::kBt601Full;
    const double y = full ? yuv[0] : (yuv[0] - 16) * 255 / 219;
    const double u = (yuv[1] - 128) * (full ? 1 : 255.0 / 224);
    const double v = (yuv[2] - 128) * (full ? 1 : 255.0 / 224);
    const double r = y + 1.402 * v;
    const double b = y + 1.772 * u;
    const double g = (y - 0.299 * r - 0.114 * b) / 0.587;
    return {std::clamp(r, 0.0, 255.0), std::clamp(g, 0.0, 255.0), std::clamp(b, 0.0, 255.0)};
  }
  const ImageView& image_;
};

// Largest difference, in 0..255.
double RegionError(const Picture& picture, const Region& region) {
  std::vector<float> crop(std::size_t{3} * kLandmarkSize * kLandmarkSize,
                          std::numeric_limits<float>::quiet_NaN());
  CropRegion(picture.view(), region, crop);
  const Reference reference(picture.view());
  double worst = 0;
  for (int j = 0; j < kLandmarkSize; ++j) {
    for (int i = 0; i < kLandmarkSize; ++i) {
      const double u = ((i + 0.5) / kLandmarkSize - 0.5) * region.side_px;
      const double v = ((j + 0.5) / kLandmarkSize - 0.5) * region.side_px;
      const double c = std::cos(region.angle_rad);
      const double s = std::sin(region.angle_rad);
      const auto rgb =
          reference.At(region.center_x_px + c * u - s * v, region.center_y_px + s * u + c * v);
      for (int k = 0; k < 3; ++k) {
        const double error = std::abs(255.0 * crop[3 * (j * kLandmarkSize + i) + k] - rgb[k]);
        worst = std::isnan(error) ? 1e9 : std::max(worst, error);
      }
    }
  }
  return worst;
}

double LetterboxError(const Picture& picture) {
  std::vector<float> crop(std::size_t{3} * kDetectorSize * kDetectorSize);
  CropLetterbox(picture.view(), crop);
  const Reference reference(picture.view());
  const double width = picture.view().width_px;
  const double height = picture.view().height_px;
  const double side = std::max(width, height);
  double worst = 0;
  for (int j = 0; j < kDetectorSize; ++j) {
    for (int i = 0; i < kDetectorSize; ++i) {
      const double x = (i + 0.5) / kDetectorSize * side - 0.5 * (side - width);
      const double y = (j + 0.5) / kDetectorSize * side - 0.5 * (side - height);
      std::array<double, 3> rgb{};
      if (x >= 0 && y >= 0 && x <= width && y <= height) rgb = reference.At(x, y);
      for (int k = 0; k < 3; ++k) {
        const double value = 127.5 * (crop[3 * (j * kDetectorSize + i) + k] + 1);
        worst = std::max(worst, std::abs(value - rgb[k]));
      }
    }
  }
  return worst;
}

using Case = std::tuple<PixelFormat, YuvEncoding>;
class CropTest : public testing::TestWithParam<Case> {
 protected:
  static Picture Make(int width, int height, int padding = 0) {
    return Noise(std::get<0>(GetParam()), width, height, padding, std::get<1>(GetParam()));
  }
};

// In noise, neighbours differ by up to 255, and a coordinate is good to about 1e-5 of the picture.
constexpr double kTolerance = 0.1;

TEST_P(CropTest, EqualsThePlainReferenceInsideThePicture) {
  EXPECT_LT(RegionError(Make(320, 240), {150.3F, 110.7F, 120.1F, 0.3F}), kTolerance);
  EXPECT_LT(RegionError(Make(320, 240), {150.3F, 110.7F, 40.0F, -1.2F}), kTolerance);
}

TEST_P(CropTest, RepeatsTheBorderOutside) {
  for (const Region region : {Region{0, 0, 200, 0.2F}, Region{320, 240, 300, 3.0F},
                              Region{160, 120, 900, -0.7F}, Region{-500, 900, 100, 0}}) {
    EXPECT_LT(RegionError(Make(320, 240), region), kTolerance);
  }
}

TEST_P(CropTest, MagnifiesASmallPicture) {
  for (const auto& [width, height] : {std::pair{2, 2}, {3, 2}, {2, 5}, {7, 3}}) {
    EXPECT_LT(RegionError(Make(width, height), {1, 1, 6, 0.5F}), kTolerance)
        << width << "x" << height;
    EXPECT_LT(LetterboxError(Make(width, height)), kTolerance) << width << "x" << height;
  }
}

TEST_P(CropTest, WorksOnOddSizesAndPaddedRows) {
  for (const int padding : {0, 1, 13}) {
    EXPECT_LT(RegionError(Make(321, 241, padding), {320, 240, 50, 0.1F}), kTolerance);
    EXPECT_LT(LetterboxError(Make(321, 241, padding)), kTolerance);
    EXPECT_LT(LetterboxError(Make(99, 241, padding)), kTolerance);
  }
}

TEST_P(CropTest, StaysInThePictureWhateverTheRegionIs) {
  const Picture picture = Make(64, 48);
  std::vector<float> crop(std::size_t{3} * kLandmarkSize * kLandmarkSize);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float inf = std::numeric_limits<float>::infinity();
  for (const float bad : {nan, inf, -inf, 3e38F, -1e20F, 0.0F}) {
    for (const Region region :
         {Region{bad, 10, 10, 0}, Region{10, bad, 10, 0}, Region{10, 10, bad, 0},
          Region{10, 10, 10, bad}, Region{bad, bad, bad, bad}}) {
      CropRegion(picture.view(), region, crop);  // the address sanitizer watches
    }
  }
}

INSTANTIATE_TEST_SUITE_P(EveryFormat, CropTest,
                         testing::Combine(testing::ValuesIn(kFormats),
                                          testing::Values(YuvEncoding::kBt601Limited,
                                                          YuvEncoding::kBt601Full)));

TEST(CheckImageTest, AcceptsEveryFormatFromTwoByTwoPixelsOn) {
  for (const PixelFormat format : kFormats) {
    EXPECT_TRUE(CheckImage(Picture(format, 2, 2).view()));
    EXPECT_TRUE(CheckImage(Picture(format, 641, 481).view()));
  }
}

TEST(CheckImageTest, RefusesPicturesThatAreTooSmallOrTooLarge) {
  for (const auto& [width, height] :
       {std::pair{0, 0}, {0, 100}, {100, 0}, {1, 100}, {100, 1}, {-4, 100}, {100000, 100}}) {
    ImageView image = Picture(PixelFormat::kBgr24, 4, 4).view();
    image.width_px = width;
    image.height_px = height;
    EXPECT_EQ(CheckImage(image).error(), Errc::kUnsupported) << width << "x" << height;
  }
}

TEST(CheckImageTest, RefusesAnUnknownFormat) {
  const Picture picture(PixelFormat::kBgr24, 4, 4);
  ImageView image = picture.view();
  image.format = static_cast<PixelFormat>(17);
  EXPECT_EQ(CheckImage(image).error(), Errc::kUnsupported);
}

TEST(CheckImageTest, RefusesMissingPlanesAndShortRows) {
  for (const PixelFormat format : kFormats) {
    const Picture picture(format, 6, 4);
    for (std::size_t plane = 0; plane < 3 && picture.view().planes[plane].data != nullptr;
         ++plane) {
      ImageView image = picture.view();
      image.planes[plane].stride_bytes -= 1;
      EXPECT_EQ(CheckImage(image).error(), Errc::kInvalidArgument);
      image = picture.view();
      image.planes[plane].data = nullptr;
      EXPECT_EQ(CheckImage(image).error(), Errc::kInvalidArgument);
    }
  }
}

}  // namespace
}  // namespace facewire::track
