#include "hal/v4l2/v4l2_camera.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cerrno>

#include "tests/hal/v4l2/camera_context.h"
#include "tests/support/allocation_counter.h"

namespace facewire::hal::v4l2 {
namespace {

using testing::HasSubstr;

TEST_F(V4l2CameraTest, HandsOutTheDriversFrames) {
  V4l2Camera camera = Make();
  ASSERT_TRUE(camera.Start()) << camera.reason();
  EXPECT_EQ(kernel.queued(), 4U);
  for (std::uint32_t n = 0; n < 20; ++n) {
    ASSERT_TRUE(kernel.Capture(100 + n, 5'000'000 + 33333 * n, static_cast<std::uint8_t>(n)));
    const Result<Frame> frame = camera.Acquire(kWait);
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->seq, n);
    EXPECT_EQ(frame->captured, Time{Duration(5'000'000 + 33333 * n)});
    EXPECT_EQ(frame->image.format, PixelFormat::kYuyv);
    EXPECT_EQ(frame->image.width_px, 640);
    EXPECT_EQ(frame->image.planes[0].stride_bytes, 1280);
    EXPECT_EQ(Value(*frame), static_cast<int>(n));
    EXPECT_EQ(kernel.queued(), 3U);
    camera.Release(*frame);
    EXPECT_EQ(kernel.queued(), 4U);
  }
  EXPECT_EQ(camera.stats().frames, 20U);
}

TEST_F(V4l2CameraTest, TellsWhatWasNegotiated) {
  V4l2Camera camera = Make();
  ASSERT_TRUE(camera.Start());
  EXPECT_EQ(camera.Describe(), "Fake Camera (fake): YUYV 640x480 at 30 fps, 4 buffers");
  EXPECT_DOUBLE_EQ(camera.mode().fps, 30);
}

TEST_F(V4l2CameraTest, EveryFormatCanBeTaken) {
  const struct {
    FakeMode mode;
    PixelFormat format;
  } rows[] = {
      {FakeKernel::Packed(V4L2_PIX_FMT_YUYV, 640, 480, 2), PixelFormat::kYuyv},
      {FakeKernel::Packed(V4L2_PIX_FMT_GREY, 640, 480, 1), PixelFormat::kGrey8},
      {FakeKernel::Packed(V4L2_PIX_FMT_RGB24, 640, 480, 3), PixelFormat::kRgb24},
      {FakeKernel::Packed(V4L2_PIX_FMT_BGR24, 640, 480, 3), PixelFormat::kBgr24},
      {FakeKernel::Planar(V4L2_PIX_FMT_NV12, 640, 480), PixelFormat::kNv12},
      {FakeKernel::Planar(V4L2_PIX_FMT_YUV420, 640, 480), PixelFormat::kI420},
  };
  for (const auto& row : rows) {
    kernel.modes = {{.fourcc = V4L2_PIX_FMT_H264, .sizeimage = 100000}, row.mode};
    V4l2Camera camera = Make();
    ASSERT_TRUE(camera.Start()) << camera.reason();
    ASSERT_TRUE(kernel.Capture(0, 1, 77));
    const Result<Frame> frame = camera.Acquire(kWait);
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->image.format, row.format);
    EXPECT_EQ(Value(*frame), 77);
  }
}

TEST_F(V4l2CameraTest, TheFirstPreferredFormatWithTheSizeWins) {
  kernel.modes = {FakeKernel::Packed(V4L2_PIX_FMT_YUYV, 320, 240, 2),
                  FakeKernel::Packed(V4L2_PIX_FMT_RGB24, 640, 480, 3),
                  FakeKernel::Planar(V4L2_PIX_FMT_NV12, 640, 480)};
  V4l2Camera camera = Make();
  ASSERT_TRUE(camera.Start());
  EXPECT_EQ(camera.mode().layout.view.format, PixelFormat::kNv12);
}

TEST_F(V4l2CameraTest, WithoutTheSizeTheBestFormatsNearestSizeIsTaken) {
  kernel.modes = {FakeKernel::Packed(V4L2_PIX_FMT_RGB24, 800, 600, 3),
                  FakeKernel::Packed(V4L2_PIX_FMT_YUYV, 320, 240, 2),
                  FakeKernel::Packed(V4L2_PIX_FMT_YUYV, 800, 600, 2)};
  V4l2Camera camera = Make();
  ASSERT_TRUE(camera.Start());
  EXPECT_EQ(camera.mode().layout.view.format, PixelFormat::kYuyv);
  EXPECT_EQ(camera.mode().layout.view.width_px, 800);
  ASSERT_TRUE(kernel.Capture(0, 1, 5));
  EXPECT_EQ(camera.Acquire(kWait)->image.height_px, 600);
}

TEST_F(V4l2CameraTest, ACameraWithOnlyFormatsThatNobodyReadsIsRefusedByName) {
  kernel.modes = {{.fourcc = V4L2_PIX_FMT_HEVC, .sizeimage = 100000},
                  {.fourcc = V4L2_PIX_FMT_H264, .sizeimage = 100000}};
  EXPECT_EQ(StartError("Fake Camera offers only HEVC, H264; one of YUYV, NV12"),
            Errc::kUnsupported);
}

TEST_F(V4l2CameraTest, RowsMayBePaddedButNotShorterThanAPicture) {
  kernel.modes = {{V4L2_PIX_FMT_YUYV, 640, 480, 1536, 1536 * 480}};
  {
    V4l2Camera camera = Make();
    ASSERT_TRUE(camera.Start());
    EXPECT_EQ(camera.mode().layout.view.planes[0].stride_bytes, 1536);
  }
  kernel.modes = {{V4L2_PIX_FMT_YUYV, 640, 480, 1000, 640 * 480 * 2}};
  EXPECT_EQ(StartError("rows of 1000 bytes"), Errc::kUnsupported);
  kernel.modes = {{V4L2_PIX_FMT_YUYV, 640, 480, 1280, 640 * 480}};
  EXPECT_EQ(StartError("contradicts itself"), Errc::kUnsupported);
}

TEST_F(V4l2CameraTest, BuffersMustHoldAPicture) {
  kernel.buffer_bytes = 640 * 480;
  EXPECT_EQ(StartError("buffers of 307200 bytes for pictures of 614400"), Errc::kUnsupported);
}

TEST_F(V4l2CameraTest, InterlacedPicturesAreRefused) {
  kernel.field = V4L2_FIELD_ALTERNATE;
  EXPECT_EQ(StartError("interlaced"), Errc::kUnsupported);
}

TEST_F(V4l2CameraTest, TheYuvRangeIsTheDevices) {
  const struct {
    std::uint32_t colorspace, quantization;
    YuvEncoding encoding;
  } rows[] = {
      {V4L2_COLORSPACE_SRGB, V4L2_QUANTIZATION_DEFAULT, YuvEncoding::kBt601Limited},
      {V4L2_COLORSPACE_JPEG, V4L2_QUANTIZATION_DEFAULT, YuvEncoding::kBt601Full},
      {V4L2_COLORSPACE_SRGB, V4L2_QUANTIZATION_FULL_RANGE, YuvEncoding::kBt601Full},
      {V4L2_COLORSPACE_JPEG, V4L2_QUANTIZATION_LIM_RANGE, YuvEncoding::kBt601Limited},
  };
  for (const auto& row : rows) {
    kernel.colorspace = row.colorspace;
    kernel.quantization = row.quantization;
    V4l2Camera camera = Make();
    ASSERT_TRUE(camera.Start());
    EXPECT_EQ(camera.mode().layout.view.encoding, row.encoding);
  }
}

TEST_F(V4l2CameraTest, ARateThatTheDeviceChangesOrRefusesIsTakenAsItIs) {
  kernel.rates = {25, 15};
  {
    V4l2Camera camera = Make();
    ASSERT_TRUE(camera.Start());
    EXPECT_DOUBLE_EQ(camera.mode().fps, 25);
  }
  config.fps = 14;
  kernel.rate_error = EINVAL;
  {
    V4l2Camera camera = Make();
    ASSERT_TRUE(camera.Start());
    EXPECT_DOUBLE_EQ(camera.mode().fps, 25);
  }
  kernel.has_rate = false;
  {
    V4l2Camera camera = Make();
    ASSERT_TRUE(camera.Start());
    EXPECT_EQ(camera.Describe(), "Fake Camera (fake): YUYV 640x480 at an unknown rate, 4 buffers");
  }
}

TEST_F(V4l2CameraTest, ARateBelowTheLowestIsRefused) {
  kernel.rates = {5};
  EXPECT_EQ(StartError("gives only 5 frames a second at 640x480; at least 10"), Errc::kUnsupported);
}

TEST_F(V4l2CameraTest, EachReasonNotToStartHasItsCodeAndItsWords) {
  config.device = "/dev/video9";
  EXPECT_EQ(StartError("no such device"), Errc::kNotFound);
  config.device = FakeKernel::kPath;
  kernel.open_error = EBUSY;
  EXPECT_EQ(StartError("another program"), Errc::kBusy);
  kernel.open_error = EACCES;
  EXPECT_EQ(StartError("group 'video'"), Errc::kPermission);
  kernel.open_error = EMFILE;
  EXPECT_EQ(StartError("cannot be opened"), Errc::kIo);
  kernel.open_error = 0;
  kernel.format_error = EBUSY;
  EXPECT_EQ(StartError("another program"), Errc::kBusy);
  kernel.format_error = 0;
  kernel.buffers_error = EBUSY;
  EXPECT_EQ(StartError("another program"), Errc::kBusy);
  kernel.buffers_error = EINVAL;
  EXPECT_EQ(StartError("no mapped buffers"), Errc::kUnsupported);
  kernel.buffers_error = 0;
  kernel.most_buffers = 1;
  EXPECT_EQ(StartError("gives 1 buffers"), Errc::kUnsupported);
  kernel.most_buffers = 32;
  kernel.stream_error = EBUSY;
  EXPECT_EQ(StartError("another program"), Errc::kBusy);
  kernel.stream_error = ENOSPC;
  EXPECT_EQ(StartError("USB bus"), Errc::kBusy);
  kernel.stream_error = EIO;
  EXPECT_EQ(StartError("does not start to stream"), Errc::kIo);
}

TEST_F(V4l2CameraTest, NodesThatAreNoCamerasAreRefused) {
  kernel.device_caps = V4L2_CAP_META_CAPTURE | V4L2_CAP_STREAMING;
  EXPECT_EQ(StartError("captures no pictures"), Errc::kUnsupported);
  kernel.device_caps = V4L2_CAP_VIDEO_CAPTURE_MPLANE | V4L2_CAP_STREAMING;
  EXPECT_EQ(StartError("several planes"), Errc::kUnsupported);
  kernel.device_caps = V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_READWRITE;
  EXPECT_EQ(StartError("cannot stream"), Errc::kUnsupported);
  kernel.is_video_device = false;
  EXPECT_EQ(StartError("not a video device"), Errc::kUnsupported);
}

TEST_F(V4l2CameraTest, AConfigurationThatMakesNoSenseIsRefused) {
  config.buffer_count = 1;
  EXPECT_EQ(StartError("2 to 32 buffers"), Errc::kInvalidArgument);
  config.buffer_count = 4;
  config.fps = 0;
  EXPECT_EQ(StartError("rate"), Errc::kInvalidArgument);
}

TEST_F(V4l2CameraTest, SilenceIsATimeoutAndTheCameraMayGoOn) {
  V4l2Camera camera = Make();
  ASSERT_TRUE(camera.Start());
  EXPECT_EQ(camera.Acquire(kWait).error(), Errc::kTimeout);
  ASSERT_TRUE(kernel.Capture(0, 1, 9));
  EXPECT_EQ(Value(*camera.Acquire(kWait)), 9);
}

TEST_F(V4l2CameraTest, TheNewestFrameWinsAndTheOthersGoBack) {
  V4l2Camera camera = Make();
  ASSERT_TRUE(camera.Start());
  for (std::uint32_t n = 0; n < 4; ++n) {
    ASSERT_TRUE(kernel.Capture(n, 1000 + n, static_cast<std::uint8_t>(n)));
  }
  const Result<Frame> first = camera.Acquire(kWait);
  ASSERT_TRUE(first);
  EXPECT_EQ(Value(*first), 3);
  EXPECT_EQ(kernel.queued(), 3U);
  EXPECT_EQ(camera.stats().superseded, 3U);
  camera.Release(*first);
  ASSERT_TRUE(kernel.Capture(7, 9000, 7));
  EXPECT_EQ(camera.Acquire(kWait)->seq, first->seq + 4);
}

TEST_F(V4l2CameraTest, DamagedFramesAreCountedAndDropped) {
  V4l2Camera camera = Make();
  ASSERT_TRUE(camera.Start());
  ASSERT_TRUE(kernel.Capture(0, 1000, 1));
  ASSERT_TRUE(kernel.Capture(1, 2000, 2, V4L2_BUF_FLAG_ERROR));
  ASSERT_TRUE(kernel.Capture(2, 3000, 3, 0, /*whole=*/false));
  const Result<Frame> frame = camera.Acquire(kWait);
  ASSERT_TRUE(frame);
  EXPECT_EQ(Value(*frame), 1);
  EXPECT_EQ(camera.counts().damaged, 2U);
  EXPECT_EQ(kernel.queued(), 3U);
  camera.Release(*frame);
  ASSERT_TRUE(kernel.Capture(3, 4000, 4, V4L2_BUF_FLAG_ERROR));
  EXPECT_EQ(camera.Acquire(kWait).error(), Errc::kTimeout);
  EXPECT_EQ(kernel.queued(), 4U);
}

TEST_F(V4l2CameraTest, SignalsAreNotErrors) {
  kernel.interrupted = true;
  V4l2Camera camera = Make();
  ASSERT_TRUE(camera.Start()) << camera.reason();
  for (std::uint32_t n = 0; n < 5; ++n) {
    ASSERT_TRUE(kernel.Capture(n, 1000 + n, static_cast<std::uint8_t>(n)));
    const Result<Frame> frame = camera.Acquire(std::chrono::seconds(5));
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->seq, n);
    camera.Release(*frame);
  }
}

TEST_F(V4l2CameraTest, AnUnpluggedCameraIsDisconnectedAndStartsAgainWhenItIsBack) {
  V4l2Camera camera = Make();
  ASSERT_TRUE(camera.Start());
  ASSERT_TRUE(kernel.Capture(0, 1000, 1));
  const Result<Frame> held = camera.Acquire(kWait);
  ASSERT_TRUE(held);
  kernel.Unplug();
  camera.Release(*held);
  EXPECT_EQ(camera.Acquire(kWait).error(), Errc::kDisconnected);
  EXPECT_EQ(camera.Acquire(kWait).error(), Errc::kDisconnected);
  EXPECT_THAT(camera.reason(), HasSubstr("has gone"));
  EXPECT_EQ(kernel.open_files(), 0);
  EXPECT_EQ(kernel.maps(), 0);
  EXPECT_EQ(camera.Start().error(), Errc::kNotFound);
  kernel.present = true;
  ASSERT_TRUE(camera.Start()) << camera.reason();
  ASSERT_TRUE(kernel.Capture(0, 2000, 2));
  EXPECT_EQ(Value(*camera.Acquire(kWait)), 2);
}

TEST_F(V4l2CameraTest, AReplugThatRenumbersTheNodeIsFoundByItsLink) {
  config.device = "/dev/v4l/by-id/usb-Maker_Camera_123-video-index0";
  kernel.links[config.device] = kernel.node;
  V4l2Camera camera = Make();
  ASSERT_TRUE(camera.Start()) << camera.reason();
  kernel.Unplug();
  kernel.links.clear();
  EXPECT_EQ(camera.Acquire(kWait).error(), Errc::kDisconnected);
  EXPECT_EQ(camera.Start().error(), Errc::kNotFound);
  // Somebody else still holds the old node, so the camera comes back as another.
  kernel.present = true;
  kernel.node = "/dev/video9";
  EXPECT_EQ(camera.Start().error(), Errc::kNotFound);
  kernel.links[config.device] = kernel.node;
  ASSERT_TRUE(camera.Start()) << camera.reason();
  ASSERT_TRUE(kernel.Capture(0, 2000, 2));
  EXPECT_EQ(Value(*camera.Acquire(kWait)), 2);
}

TEST_F(V4l2CameraTest, ACameraThatFallsSilentCanBeStoppedAndStartedAgain) {
  V4l2Camera camera = Make();
  ASSERT_TRUE(camera.Start());
  ASSERT_TRUE(kernel.Capture(0, 1000, 1));
  const Result<Frame> held = camera.Acquire(kWait);
  ASSERT_TRUE(held);
  camera.Release(*held);
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(camera.Acquire(kWait).error(), Errc::kTimeout);
    EXPECT_TRUE(camera.reason().empty());
  }
  camera.Stop();
  EXPECT_EQ(kernel.open_files(), 0);
  ASSERT_TRUE(camera.Start());
  ASSERT_TRUE(kernel.Capture(0, 2000, 2));
  EXPECT_EQ(Value(*camera.Acquire(kWait)), 2);
}

TEST_F(V4l2CameraTest, SaysWhenASilentCameraSendsOnlyDamagedPictures) {
  V4l2Camera camera = Make();
  ASSERT_TRUE(camera.Start());
  ASSERT_TRUE(kernel.Capture(0, 1000, 1, V4L2_BUF_FLAG_ERROR));
  EXPECT_EQ(camera.Acquire(kWait).error(), Errc::kTimeout);
  EXPECT_THAT(camera.reason(), HasSubstr("sends only damaged pictures"));
  EXPECT_EQ(camera.counts().damaged, 1U);
  EXPECT_EQ(camera.Acquire(kWait).error(), Errc::kTimeout);
  EXPECT_EQ(camera.reason(), "");
}

TEST_F(V4l2CameraTest, CountsAreSinceStart) {
  V4l2Camera camera = Make();
  ASSERT_TRUE(camera.Start());
  ASSERT_TRUE(kernel.Capture(0, 1000, 1, V4L2_BUF_FLAG_ERROR));
  EXPECT_FALSE(camera.Acquire(kWait));
  camera.Stop();
  EXPECT_EQ(camera.counts().damaged, 1U);
  ASSERT_TRUE(camera.Start());
  EXPECT_EQ(camera.counts().damaged, 0U);
}

TEST_F(V4l2CameraTest, AnErrorOfACameraThatIsStillThereLeavesItRunning) {
  V4l2Camera camera = Make();
  ASSERT_TRUE(camera.Start());
  kernel.dequeue_error = EIO;
  EXPECT_EQ(camera.Acquire(kWait).error(), Errc::kIo);
  kernel.dequeue_error = 0;
  ASSERT_TRUE(kernel.Capture(0, 1000, 1));
  EXPECT_TRUE(camera.Acquire(kWait));
}

TEST_F(V4l2CameraTest, WithoutAMonotonicStampTheClocksTimeIsTaken) {
  kernel.stamps = V4L2_BUF_FLAG_TIMESTAMP_UNKNOWN;
  V4l2Camera camera = Make();
  ASSERT_TRUE(camera.Start());
  ASSERT_TRUE(kernel.Capture(0, 99, 1));
  EXPECT_EQ(camera.Acquire(kWait)->captured, clock.Now());
}

TEST_F(V4l2CameraTest, SequenceSurvivesWrapRepeatAndRestartOfTheDriversCount) {
  V4l2Camera camera = Make();
  ASSERT_TRUE(camera.Start());
  std::vector<std::uint64_t> seqs;
  std::int64_t stamp = 0;
  for (const std::uint32_t sequence : {0xFFFFFFFEU, 0xFFFFFFFFU, 1U, 1U, 5U, 0U}) {
    ASSERT_TRUE(kernel.Capture(sequence, ++stamp, 1));
    const Result<Frame> frame = camera.Acquire(kWait);
    ASSERT_TRUE(frame);
    seqs.push_back(frame->seq);
    camera.Release(*frame);
  }
  EXPECT_EQ(seqs, (std::vector<std::uint64_t>{0, 1, 3, 4, 8, 9}));
}

TEST_F(V4l2CameraTest, StopGivesEverythingBackAndStartBeginsAnew) {
  V4l2Camera camera = Make();
  ASSERT_TRUE(camera.Start());
  ASSERT_TRUE(camera.Start());
  EXPECT_EQ(kernel.open_files(), 1);
  ASSERT_TRUE(kernel.Capture(40, 1, 1));
  ASSERT_TRUE(camera.Acquire(kWait));
  camera.Stop();
  EXPECT_EQ(kernel.open_files(), 0);
  EXPECT_EQ(kernel.maps(), 0);
  EXPECT_EQ(camera.Acquire(kWait).error(), Errc::kDisconnected);
  ASSERT_TRUE(camera.Start());
  ASSERT_TRUE(kernel.Capture(0, 2, 2));
  EXPECT_EQ(camera.Acquire(kWait)->seq, 0U);
}

TEST_F(V4l2CameraTest, AcquiringAllocatesNothing) {
  using facewire::test::AllocationCounter;
  if (!AllocationCounter::kAvailable) GTEST_SKIP() << AllocationCounter::kWhyNot;
  V4l2Camera camera = Make();
  ASSERT_TRUE(camera.Start());
  ASSERT_TRUE(kernel.Capture(0, 1000, 1));
  ASSERT_TRUE(kernel.Capture(1, 2000, 2));
  AllocationCounter counter;
  counter.Arm();
  const Result<Frame> frame = camera.Acquire(kWait);
  const Result<Frame> silence = camera.Acquire(kWait);
  kernel.present = false;
  const Result<Frame> gone = camera.Acquire(kWait);
  counter.Disarm();
  counter.PrintFirst();
  EXPECT_TRUE(frame);
  EXPECT_EQ(silence.error(), Errc::kTimeout);
  EXPECT_EQ(gone.error(), Errc::kDisconnected);
  EXPECT_EQ(counter.allocations(), 0U);
}

TEST(V4l2Camera, TheRunningKernelRefusesWhatIsNoCamera) {
  fake::FakeClock clock;
  V4l2Camera missing({.device = "/dev/video-of-nobody"}, clock);
  EXPECT_EQ(missing.Start().error(), Errc::kNotFound);
  V4l2Camera null({.device = "/dev/null"}, clock);
  EXPECT_EQ(null.Start().error(), Errc::kUnsupported);
  EXPECT_EQ(null.reason(), "/dev/null: not a video device");
}

}  // namespace
}  // namespace facewire::hal::v4l2
