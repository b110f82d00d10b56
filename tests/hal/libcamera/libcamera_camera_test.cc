#include "hal/libcamera/libcamera_camera.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <utility>

#include "hal/fake/fake_clock.h"
#include "hal/libcamera/list.h"
#include "tests/hal/libcamera/fake_session.h"
#include "tests/support/allocation_counter.h"
#include "tests/support/jpeg_picture.h"

namespace facewire::hal::libcamera {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr milliseconds kNoWait{0};

struct LibcameraCameraTest : public ::testing::Test {
  fake::FakeClock clock{Time{seconds(50)}};
  LibcameraConfig config;
  std::unique_ptr<FakeSession> owned = std::make_unique<FakeSession>();
  FakeSession& session = *owned;

  LibcameraCamera Make() { return {config, clock, std::move(owned)}; }
};

int Value(const Result<Frame>& frame) { return frame->image.planes[0].data[0]; }

TEST_F(LibcameraCameraTest, HandsOutTheCamerasPicturesAndGivesTheirMemoryBack) {
  LibcameraCamera camera = Make();
  ASSERT_TRUE(camera.Start()) << camera.reason();
  for (std::uint64_t n = 0; n < 20; ++n) {
    session.Capture(static_cast<std::uint8_t>(n), 50'000'000'000 + n);
    const Result<Frame> frame = camera.Acquire(kNoWait);
    ASSERT_TRUE(frame) << camera.reason();
    EXPECT_EQ(frame->seq, n);
    EXPECT_EQ(frame->captured, Time{seconds(50)});
    EXPECT_EQ(frame->image.format, PixelFormat::kYuyv);
    EXPECT_EQ(frame->image.width_px, 64);
    EXPECT_EQ(frame->image.planes[0].stride_bytes, 128);
    EXPECT_EQ(Value(frame), static_cast<int>(n));
    EXPECT_EQ(session.queued.size(), 3U);
    camera.Release(*frame);
    EXPECT_EQ(session.queued.size(), 4U);
  }
}

TEST_F(LibcameraCameraTest, TheNewestPictureWinsAndTheOthersShowAsAGap) {
  LibcameraCamera camera = Make();
  ASSERT_TRUE(camera.Start());
  session.Capture(1);
  camera.Release(*camera.Acquire(kNoWait));
  for (std::uint8_t n = 2; n <= 4; ++n) session.Capture(n);
  const Result<Frame> frame = camera.Acquire(kNoWait);
  ASSERT_TRUE(frame);
  EXPECT_EQ(Value(frame), 4);
  EXPECT_EQ(frame->seq, 3U);
  EXPECT_EQ(session.queued.size(), 3U);
}

TEST_F(LibcameraCameraTest, AHeldPictureStaysWhileOthersArrive) {
  LibcameraCamera camera = Make();
  ASSERT_TRUE(camera.Start());
  session.Capture(1);
  const Result<Frame> held = camera.Acquire(kNoWait);
  for (std::uint8_t n = 2; n < 20; ++n) session.Capture(n);
  EXPECT_EQ(Value(held), 1);
}

TEST_F(LibcameraCameraTest, ASilentCameraIsATimeoutAndGoesOn) {
  LibcameraCamera camera = Make();
  ASSERT_TRUE(camera.Start());
  EXPECT_EQ(camera.Acquire(milliseconds(5)).error(), Errc::kTimeout);
  EXPECT_THAT(camera.reason(), IsEmpty());
  session.Capture(1);
  EXPECT_TRUE(camera.Acquire(kNoWait));
}

TEST_F(LibcameraCameraTest, DamagedPicturesAreDroppedAndCounted) {
  LibcameraCamera camera = Make();
  ASSERT_TRUE(camera.Start());
  const std::vector<std::uint8_t> data(session.plane_bytes[0], 9);
  session.Capture(data, {data.size()}, 0, false);  // the driver says so
  session.Capture(data, {data.size() - 1});        // too short
  EXPECT_EQ(camera.Acquire(kNoWait).error(), Errc::kTimeout);
  EXPECT_THAT(std::string(camera.reason()), HasSubstr("sends only damaged pictures"));
  EXPECT_EQ(camera.counts().damaged, 2U);
  EXPECT_EQ(session.queued.size(), 4U);
  session.Capture(1);
  session.Capture(data, {data.size()}, 0, false);
  const Result<Frame> frame = camera.Acquire(kNoWait);  // the last good one
  ASSERT_TRUE(frame);
  EXPECT_EQ(Value(frame), 1);
  EXPECT_EQ(camera.counts().damaged, 3U);
}

TEST_F(LibcameraCameraTest, JpegsAreDecodedAndTheirMemoryIsFreeAtOnce) {
  session.negotiated.mode.format = CameraFormat::kMjpeg;
  const test::JpegOptions options{.shade = 200};
  const test::Jpeg jpeg = test::MakeJpeg(options);
  session.plane_bytes = {jpeg.size() + 1000};  // more room than a picture takes
  LibcameraCamera camera = Make();
  ASSERT_TRUE(camera.Start());
  session.Capture(jpeg, {jpeg.size()});
  const Result<Frame> frame = camera.Acquire(kNoWait);
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->image.format, PixelFormat::kRgb24);
  EXPECT_EQ(frame->image.height_px, 48);
  const std::uint8_t* const pixel = frame->image.planes[0].data;
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(pixel[i], test::PixelAt(options, 0, 0)[static_cast<std::size_t>(i)], 12);
  }
  EXPECT_EQ(session.queued.size(), 4U);
  camera.Release(*frame);
  EXPECT_EQ(session.queued.size(), 4U);
}

TEST_F(LibcameraCameraTest, ABrokenJpegIsDroppedAndCounted) {
  session.negotiated.mode.format = CameraFormat::kMjpeg;
  const test::Jpeg jpeg = test::MakeJpeg({});
  session.plane_bytes = {jpeg.size()};
  LibcameraCamera camera = Make();
  ASSERT_TRUE(camera.Start());
  session.Capture(jpeg, {jpeg.size() / 2});
  EXPECT_EQ(camera.Acquire(kNoWait).error(), Errc::kTimeout);
  EXPECT_EQ(camera.counts().damaged, 1U);
  session.Capture(jpeg, {jpeg.size() * 2});  // a driver that says more than there is
  const Result<Frame> frame = camera.Acquire(kNoWait);
  ASSERT_TRUE(frame);
  EXPECT_EQ(session.queued.size(), 4U);
}

TEST_F(LibcameraCameraTest, PlanesOfTheirOwnMakeOnePicture) {
  session.negotiated.mode.format = CameraFormat::kNv12;
  session.negotiated.yuv = YuvEncoding::kBt601Full;
  session.plane_bytes = {std::size_t{64} * 48, std::size_t{64} * 24};
  LibcameraCamera camera = Make();
  ASSERT_TRUE(camera.Start());
  session.Capture(3);
  const Result<Frame> frame = camera.Acquire(kNoWait);
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->image.encoding, YuvEncoding::kBt601Full);
  EXPECT_EQ(frame->image.planes[1].data - frame->image.planes[0].data, 64 * 48);
  camera.Release(*frame);
  const std::vector<std::uint8_t> data(std::size_t{64} * 72);
  session.Capture(data, {std::size_t{64} * 48, 1});  // colour is missing
  EXPECT_EQ(camera.Acquire(kNoWait).error(), Errc::kTimeout);
  EXPECT_EQ(camera.counts().damaged, 1U);
}

TEST_F(LibcameraCameraTest, ACameraThatIsPulledOutIsGoneUntilItIsStartedAgain) {
  config.camera = "3";
  LibcameraCamera camera = Make();
  ASSERT_TRUE(camera.Start());
  session.Capture(1);
  camera.Release(*camera.Acquire(kNoWait));
  session.Unplug();
  EXPECT_EQ(camera.Acquire(seconds(60)).error(), Errc::kDisconnected);
  EXPECT_EQ(camera.reason(), "libcamera:3: the camera has gone");
  EXPECT_FALSE(session.open);
  EXPECT_EQ(camera.Acquire(seconds(60)).error(), Errc::kDisconnected);
  session.refusal = Errc::kNotFound;
  EXPECT_EQ(camera.Start().error(), Errc::kNotFound);
  EXPECT_EQ(camera.reason(), "libcamera:3: is not there");
  session.refusal = Errc{};
  ASSERT_TRUE(camera.Start());
  EXPECT_THAT(camera.reason(), IsEmpty());
  session.Capture(2);
  const Result<Frame> frame = camera.Acquire(kNoWait);
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->seq, 0U);
  EXPECT_EQ(camera.counts().damaged, 0U);
}

TEST_F(LibcameraCameraTest, ACameraThatIsPulledOutWhileAPictureIsHeld) {
  LibcameraCamera camera = Make();
  ASSERT_TRUE(camera.Start());
  session.Capture(1);
  const Result<Frame> held = camera.Acquire(kNoWait);
  session.Unplug();
  session.takes_buffers = false;
  EXPECT_EQ(Value(held), 1);
  camera.Release(*held);
  EXPECT_EQ(camera.Acquire(kNoWait).error(), Errc::kDisconnected);
}

TEST_F(LibcameraCameraTest, StoppingTakesBackAPictureThatIsStillOut) {
  LibcameraCamera camera = Make();
  for (int round = 0; round < 3; ++round) {
    ASSERT_TRUE(camera.Start());
    ASSERT_TRUE(camera.Start());  // running already
    session.Capture(1);
    const Result<Frame> frame = camera.Acquire(kNoWait);
    ASSERT_TRUE(frame);
    camera.Stop();
    camera.Release(*frame);
    EXPECT_FALSE(session.open);
    EXPECT_EQ(camera.Acquire(kNoWait).error(), Errc::kDisconnected);
  }
  EXPECT_EQ(session.opened, 3);
}

TEST_F(LibcameraCameraTest, AModeThatDoesNotFitIntoItsBuffersIsRefused) {
  session.negotiated.stride_bytes = 256;
  LibcameraCamera camera = Make();
  EXPECT_EQ(camera.Start().error(), Errc::kUnsupported);
  EXPECT_THAT(camera.reason(), HasSubstr("yuyv 64x48 with rows of 256 bytes"));
  EXPECT_FALSE(session.open);
}

TEST_F(LibcameraCameraTest, WishesThatNoCameraHasAreRefusedBeforeItIsAsked) {
  config.width_px = 0;
  LibcameraCamera camera = Make();
  EXPECT_EQ(camera.Start().error(), Errc::kInvalidArgument);
  EXPECT_EQ(session.opened, 0);
}

TEST_F(LibcameraCameraTest, TellsWhatWasAgreedOn) {
  LibcameraCamera camera = Make();
  ASSERT_TRUE(camera.Start());
  EXPECT_EQ(camera.Describe(), "Fake (/base/i2c/camera@10): yuyv 64x48 at 30 fps, 4 buffers");
}

TEST_F(LibcameraCameraTest, AllocatesNothingOnceStarted) {
  if (!test::AllocationCounter::kAvailable) GTEST_SKIP() << test::AllocationCounter::kWhyNot;
  for (const CameraFormat format : {CameraFormat::kYuyv, CameraFormat::kMjpeg}) {
    auto fake = std::make_unique<FakeSession>();
    FakeSession& one = *fake;
    const test::Jpeg jpeg = test::MakeJpeg({});
    one.negotiated.mode.format = format;
    if (format == CameraFormat::kMjpeg) one.plane_bytes = {jpeg.size()};
    LibcameraCamera camera(config, clock, std::move(fake));
    ASSERT_TRUE(camera.Start());
    for (int i = 0; i < 3; ++i) {
      const bool compressed = format == CameraFormat::kMjpeg;
      if (compressed) {
        one.Capture(jpeg, {jpeg.size()});
      } else {
        one.Capture(1);
      }
      one.queued.clear();  // the fake's own set, which allocates, stays out of it
      one.takes_buffers = false;
      test::AllocationCounter counter;
      counter.Arm();
      const Result<Frame> frame = camera.Acquire(kNoWait);
      if (frame) camera.Release(*frame);
      counter.Disarm();
      EXPECT_TRUE(frame);
      EXPECT_EQ(counter.allocations(), 0U);
      one.takes_buffers = true;
      for (int buffer = 0; buffer < 4; ++buffer) one.queued.insert(buffer);
    }
  }
}

// libcamera itself, which finds no camera on most machines that build. One that has some lists
// them.
TEST(LibcameraLibrary, ACameraThatIsNotThereIsNamedInOneLine) {
  fake::FakeClock clock;
  LibcameraConfig config;
  config.camera = "no such camera";
  LibcameraCamera camera(config, clock);
  const Result<> started = camera.Start();
  ASSERT_FALSE(started);
  EXPECT_TRUE(started.error() == Errc::kNotFound || started.error() == Errc::kPermission);
  EXPECT_THAT(std::string(camera.reason()), HasSubstr("libcamera:no such camera: "));
  EXPECT_EQ(camera.reason().find('\n'), std::string_view::npos);
  EXPECT_FALSE(camera.Start());  // as often as one likes
}

TEST(LibcameraLibrary, ListsWhatItHas) {
  for (const CameraInfo& camera : ListCameras()) {
    EXPECT_EQ(camera.address.substr(0, 10), "libcamera:");
  }
}

}  // namespace
}  // namespace facewire::hal::libcamera
