#include "hal/v4l2/fourcc.h"

#include <gtest/gtest.h>
#include <linux/videodev2.h>

namespace facewire::hal::v4l2 {
namespace {

TEST(Fourcc, EveryFormatHasACodeAndComesBackFromIt) {
  for (const CameraFormat format : kEveryCameraFormat) {
    EXPECT_EQ(FormatOf(FourccOf(format)), format);
  }
  EXPECT_EQ(FormatOf(V4L2_PIX_FMT_H264), std::nullopt);
  EXPECT_STREQ(FourccText(V4L2_PIX_FMT_MJPEG).data(), "MJPG");
  EXPECT_STREQ(FourccText(0x01020304).data(), "????");
}

}  // namespace
}  // namespace facewire::hal::v4l2
