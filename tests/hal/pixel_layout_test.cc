#include "hal/pixel_layout.h"

#include <gtest/gtest.h>

namespace facewire::hal {
namespace {

struct Row {
  PixelFormat format;
  std::uint32_t stride;
  std::array<int, 3> strides;
  std::array<std::size_t, 3> offsets;
  std::size_t bytes;
};
const Row kRows[] = {
    {PixelFormat::kGrey8, 0, {8, 0, 0}, {0, 0, 0}, 32},
    {PixelFormat::kGrey8, 16, {16, 0, 0}, {0, 0, 0}, 64},
    {PixelFormat::kYuyv, 0, {16, 0, 0}, {0, 0, 0}, 64},
    {PixelFormat::kRgb24, 0, {24, 0, 0}, {0, 0, 0}, 96},
    {PixelFormat::kBgr24, 32, {32, 0, 0}, {0, 0, 0}, 128},
    {PixelFormat::kNv12, 0, {8, 8, 0}, {0, 32, 0}, 48},
    {PixelFormat::kNv12, 64, {64, 64, 0}, {0, 256, 0}, 384},
    {PixelFormat::kI420, 0, {8, 4, 4}, {0, 32, 40}, 48},
    {PixelFormat::kI420, 64, {64, 32, 32}, {0, 256, 320}, 384},
};

TEST(PixelLayout, PlacesThePlanesOfAnEightByFourPicture) {
  for (const Row& row : kRows) {
    const Result<PixelLayout> layout = LayOut(row.format, 8, 4, row.stride);
    ASSERT_TRUE(layout);
    EXPECT_EQ(layout->bytes, row.bytes);
    const std::uint8_t buffer[1] = {};
    const ImageView view = layout->At(buffer);
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_EQ(view.planes[i].stride_bytes, row.strides[i]);
      const std::uint8_t* expected = row.strides[i] > 0 ? buffer + row.offsets[i] : nullptr;
      EXPECT_EQ(view.planes[i].data, expected);
    }
  }
}

TEST(PixelLayout, RefusesWhatContradictsItself) {
  EXPECT_EQ(LayOut(PixelFormat::kYuyv, 8, 4, 15).error(), Errc::kUnsupported);
  EXPECT_EQ(LayOut(PixelFormat::kYuyv, 7, 4, 0).error(), Errc::kUnsupported);
  EXPECT_EQ(LayOut(PixelFormat::kNv12, 8, 3, 0).error(), Errc::kUnsupported);
  EXPECT_EQ(LayOut(PixelFormat::kGrey8, 0, 4, 0).error(), Errc::kUnsupported);
  EXPECT_EQ(LayOut(PixelFormat::kGrey8, 8, -4, 0).error(), Errc::kUnsupported);
  EXPECT_EQ(LayOut(PixelFormat::kGrey8, 1 << 20, 4, 0).error(), Errc::kUnsupported);
  EXPECT_EQ(LayOut(PixelFormat::kGrey8, 8, 4, 0xFFFFFFFF).error(), Errc::kUnsupported);
}

}  // namespace
}  // namespace facewire::hal
