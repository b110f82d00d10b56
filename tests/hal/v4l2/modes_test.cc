// What V4l2Camera chooses among formats, sizes and rates.

#include <cerrno>

#include "tests/hal/v4l2/camera_context.h"

namespace facewire::hal::v4l2 {
namespace {

using testing::HasSubstr;

FakeMode With(FakeMode mode, std::vector<std::uint32_t> rates, bool range = false) {
  mode.rates = std::move(rates);
  mode.range = range;
  return mode;
}
FakeMode Yuyv(std::uint32_t width, std::uint32_t height, std::vector<std::uint32_t> rates) {
  return With(FakeKernel::Packed(V4L2_PIX_FMT_YUYV, width, height, 2), std::move(rates));
}
FakeMode Mjpeg(std::uint32_t width, std::uint32_t height, std::vector<std::uint32_t> rates) {
  return With(FakeKernel::Mjpeg(width, height), std::move(rates));
}

// A webcam as most are: uncompressed where USB 2 has room for it.
std::vector<FakeMode> Webcam() {
  return {Mjpeg(1280, 720, {60, 30}), Mjpeg(640, 480, {60, 30}), Yuyv(1280, 720, {10, 5}),
          Yuyv(640, 480, {30, 15})};
}

TEST_F(V4l2CameraTest, UncompressedIsTakenWhereItReachesTheRate) {
  kernel.modes = Webcam();
  EXPECT_THAT(Negotiated(), HasSubstr("YUYV 640x480 at 30 fps"));
}

TEST_F(V4l2CameraTest, CompressedIsTakenWhereUncompressedIsTooSlow) {
  kernel.modes = Webcam();
  config.width_px = 1280;
  config.height_px = 720;
  EXPECT_THAT(Negotiated(), HasSubstr("MJPG 1280x720 at 30 fps"));
  config.width_px = 640;
  config.height_px = 480;
  config.fps = 60;
  EXPECT_THAT(Negotiated(), HasSubstr("MJPG 640x480 at 60 fps"));
}

TEST_F(V4l2CameraTest, CompressedIsTakenWhereUncompressedLacksTheSize) {
  kernel.modes = {Yuyv(320, 240, {30}), Mjpeg(640, 480, {30})};
  EXPECT_THAT(Negotiated(), HasSubstr("MJPG 640x480 at 30 fps"));
}

TEST_F(V4l2CameraTest, WhenNoneReachesTheRateTheFastestIsTaken) {
  kernel.modes = {Yuyv(640, 480, {15}), Mjpeg(640, 480, {20, 10})};
  EXPECT_THAT(Negotiated(), HasSubstr("MJPG 640x480 at 20 fps"));
}

TEST_F(V4l2CameraTest, ARateNextToTheWantedOneReachesIt) {
  kernel.modes = {Yuyv(640, 480, {29}), Mjpeg(640, 480, {30})};
  EXPECT_THAT(Negotiated(), HasSubstr("YUYV 640x480 at 29 fps"));
}

TEST_F(V4l2CameraTest, ARateOutOfARangeIsSetExactly) {
  config.fps = 24;
  kernel.modes = {
      With(FakeKernel::Packed(V4L2_PIX_FMT_YUYV, 640, 480, 2), {60, 5}, /*range=*/true)};
  EXPECT_THAT(Negotiated(), HasSubstr("at 24 fps"));
}

TEST_F(V4l2CameraTest, OnlyTheFormatsThatAreAskedForAreTaken) {
  kernel.modes = Webcam();
  config.formats = {CameraFormat::kMjpeg};
  EXPECT_THAT(Negotiated(), HasSubstr("MJPG 640x480 at 30 fps"));
  config.formats = {CameraFormat::kNv12};
  EXPECT_EQ(StartError("offers only MJPG, YUYV; one of NV12 is needed"), Errc::kUnsupported);
}

TEST_F(V4l2CameraTest, TheRateIsKeptInTheDarkWhereTheCameraLetsOne) {
  kernel.controls[V4L2_CID_EXPOSURE_AUTO_PRIORITY] = 1;
  kernel.controls[V4L2_CID_BRIGHTNESS] = 7;
  V4l2Camera camera = Make();
  ASSERT_TRUE(camera.Start());
  EXPECT_EQ(kernel.controls[V4L2_CID_EXPOSURE_AUTO_PRIORITY], 0);
  EXPECT_EQ(kernel.controls[V4L2_CID_BRIGHTNESS], 7);
}

}  // namespace
}  // namespace facewire::hal::v4l2
