// V4l2Camera on a device that compresses its pictures.

#include "tests/hal/v4l2/camera_context.h"
#include "tests/support/allocation_counter.h"
#include "tests/support/jpeg_picture.h"

namespace facewire::hal::v4l2 {
namespace {

using facewire::test::Jpeg;
using facewire::test::MakeJpeg;
using testing::HasSubstr;

struct MjpegTest : public V4l2CameraTest {
  MjpegTest() {
    config.width_px = 320;
    config.height_px = 240;
    kernel.modes = {FakeKernel::Mjpeg(320, 240)};
  }
  static Jpeg Picture(int shade) {
    return MakeJpeg({.width_px = 320, .height_px = 240, .shade = shade});
  }
  static Jpeg Half(Jpeg jpeg) {
    jpeg.resize(jpeg.size() / 2);
    return jpeg;
  }
  // The blue of the picture's middle, which Picture made of its shade.
  static int Shade(const Frame& frame) {
    return frame.image.planes[0].data[120 * frame.image.planes[0].stride_bytes + 3 * 160 + 2];
  }
};

TEST_F(MjpegTest, HandsOutDecodedPicturesAndTheBufferGoesBackAtOnce) {
  V4l2Camera camera = Make();
  ASSERT_TRUE(camera.Start()) << camera.reason();
  EXPECT_EQ(camera.Describe(), "Fake Camera (fake): MJPG 320x240 at 30 fps, 4 buffers");
  for (std::uint32_t n = 0; n < 10; ++n) {
    const int shade = 20 * static_cast<int>(n);
    ASSERT_TRUE(kernel.CaptureJpeg(5 + n, 1000 * (n + 1), Picture(shade)));
    const Result<Frame> frame = camera.Acquire(kWait);
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->seq, n);
    EXPECT_EQ(frame->captured, Time{Duration(1000 * (n + 1))});
    EXPECT_EQ(frame->image.format, PixelFormat::kRgb24);
    EXPECT_EQ(frame->image.width_px, 320);
    EXPECT_EQ(frame->image.height_px, 240);
    EXPECT_NEAR(Shade(*frame), shade, 12);
    EXPECT_EQ(kernel.queued(), 4U);
    camera.Release(*frame);
    EXPECT_EQ(kernel.queued(), 4U);
  }
}

TEST_F(MjpegTest, TheNewestPictureWins) {
  V4l2Camera camera = Make();
  ASSERT_TRUE(camera.Start());
  for (std::uint32_t n = 0; n < 3; ++n) {
    ASSERT_TRUE(kernel.CaptureJpeg(n, 1000 + n, Picture(static_cast<int>(80 * n))));
  }
  EXPECT_NEAR(Shade(*camera.Acquire(kWait)), 160, 12);
  EXPECT_EQ(camera.stats().superseded, 2U);
}

TEST_F(MjpegTest, ADamagedPictureIsCountedAndTheNextOneIsWaitedFor) {
  V4l2Camera camera = Make();
  ASSERT_TRUE(camera.Start());
  ASSERT_TRUE(kernel.CaptureJpeg(0, 1000, Half(Picture(50))));
  // The next picture comes while the camera waits.
  kernel.on_empty_poll = [this] { ASSERT_TRUE(kernel.CaptureJpeg(1, 2000, Picture(90))); };
  const Result<Frame> frame = camera.Acquire(kWait);
  ASSERT_TRUE(frame) << camera.reason();
  EXPECT_NEAR(Shade(*frame), 90, 12);
  EXPECT_EQ(camera.counts().damaged, 1U);
  EXPECT_EQ(kernel.queued(), 4U);
}

TEST_F(MjpegTest, EveryKindOfDamageIsCountedAndDropped) {
  V4l2Camera camera = Make();
  ASSERT_TRUE(camera.Start());
  const Jpeg good = Picture(50);
  const Jpeg headless(good.begin() + 2, good.end());
  const Jpeg other_size = MakeJpeg({.width_px = 160, .height_px = 120});
  // More than the buffer holds: what a driver that lies about its bytes would say.
  const Jpeg too_long(std::size_t{320} * 240 + 5000, 0xFF);
  std::uint32_t n = 0;
  for (const Jpeg& bad : {Jpeg{}, Half(good), headless, other_size, too_long}) {
    ASSERT_TRUE(kernel.CaptureJpeg(n++, 1000, bad));
    EXPECT_EQ(camera.Acquire(kWait).error(), Errc::kTimeout);
    EXPECT_THAT(camera.reason(), HasSubstr("sends only damaged pictures"));
    EXPECT_EQ(camera.counts().damaged, n);
    EXPECT_EQ(kernel.queued(), 4U);
  }
  ASSERT_TRUE(kernel.CaptureJpeg(n, 2000, good));
  const Result<Frame> frame = camera.Acquire(kWait);
  ASSERT_TRUE(frame);
  EXPECT_NEAR(Shade(*frame), 50, 12);
}

TEST_F(MjpegTest, DamageShowsAsAGapInTheNumbers) {
  V4l2Camera camera = Make();
  ASSERT_TRUE(camera.Start());
  ASSERT_TRUE(kernel.CaptureJpeg(0, 1000, Picture(50)));
  EXPECT_EQ(camera.Acquire(kWait)->seq, 0U);
  ASSERT_TRUE(kernel.CaptureJpeg(1, 1000, Half(Picture(50))));
  EXPECT_FALSE(camera.Acquire(kWait));
  ASSERT_TRUE(kernel.CaptureJpeg(2, 1000, Picture(50)));
  EXPECT_EQ(camera.Acquire(kWait)->seq, 2U);
}

TEST_F(MjpegTest, AnUnpluggedCameraGivesTheDecoderBackAndStartsAgain) {
  V4l2Camera camera = Make();
  ASSERT_TRUE(camera.Start());
  kernel.Unplug();
  EXPECT_EQ(camera.Acquire(kWait).error(), Errc::kDisconnected);
  EXPECT_EQ(kernel.maps(), 0);
  kernel.present = true;
  kernel.modes = {FakeKernel::Packed(V4L2_PIX_FMT_YUYV, 320, 240, 2)};
  ASSERT_TRUE(camera.Start());
  ASSERT_TRUE(kernel.Capture(0, 1000, 44));
  EXPECT_EQ(Value(*camera.Acquire(kWait)), 44);
}

TEST_F(MjpegTest, AcquiringAllocatesNothing) {
  using facewire::test::AllocationCounter;
  if (!AllocationCounter::kAvailable) GTEST_SKIP() << AllocationCounter::kWhyNot;
  V4l2Camera camera = Make();
  ASSERT_TRUE(camera.Start());
  AllocationCounter counter;
  for (std::uint32_t n = 0; n < 6; ++n) {
    const bool whole = n % 2 == 0;
    ASSERT_TRUE(kernel.CaptureJpeg(n, 1000, whole ? Picture(50) : Half(Picture(50))));
    counter.Arm();
    const Result<Frame> frame = camera.Acquire(kWait);
    if (frame) camera.Release(*frame);
    counter.Disarm();
    EXPECT_EQ(frame.has_value(), whole);
    EXPECT_EQ(counter.allocations(), 0U);
  }
}

}  // namespace
}  // namespace facewire::hal::v4l2
