// V4l2Camera on a driver that the kernel itself provides: what the fake kernel of tests/hal/v4l2
// claims about kernels is held against one.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <thread>

#include "hal/system_clock.h"
#include "hal/v4l2/fourcc.h"
#include "hal/v4l2/v4l2_camera.h"
#include "tests/devices/vivid.h"

namespace facewire::devices {
namespace {

using hal::v4l2::V4l2Camera;
using hal::v4l2::V4l2Config;
using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr milliseconds kAmple{5000};
// Of vivid's menu of test patterns.
constexpr int kBarsOf75Percent = 0;
constexpr int kWhite = 6;

class VividCameraTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (VideoNode(Vivid::kCapture).empty()) Vivid::Plug();
    vivid.SelectInput(0);
    vivid.Set("Test Pattern", kBarsOf75Percent);
    vivid.Set("OSD Text Mode", 2);     // no writing over them
    vivid.Set("Timestamp Source", 1);  // the start of exposure; the end is stamped ahead of time
    vivid.Set("Percentage of Dropped Buffers", 0);
    vivid.Set("Wrap Sequence Number", 0);
  }
  V4l2Camera Make() { return {Config(), clock}; }
  V4l2Config Config() {
    V4l2Config config;
    config.device = vivid.node();
    return config;
  }
  Errc StartError(V4l2Config config, const std::string& reason) {
    V4l2Camera camera(std::move(config), clock);
    const Result<> started = camera.Start();
    EXPECT_NE(std::string(camera.reason()).find(reason), std::string::npos) << camera.reason();
    return started ? Errc{} : started.error();
  }
  // The first failure, while every frame goes back; {} when `limit` frames came before.
  static Errc UntilFailure(V4l2Camera& camera, int limit = 100) {
    for (int i = 0; i < limit; ++i) {
      const Result<Frame> frame = camera.Acquire(kAmple);
      if (!frame) return frame.error();
      camera.Release(*frame);
    }
    return {};
  }
  static void ExpectFrames(V4l2Camera& camera, int count = 5) {
    EXPECT_EQ(UntilFailure(camera, count), Errc{}) << camera.reason();
  }

  Vivid vivid;
  hal::SystemClock clock;
};

struct Rgb {
  int r, g, b;
};

// The pixel as a person sees it, by the textbook (ITU-R BT.601, 8 bits) and not by core's own code.
Rgb Seen(const ImageView& image, int x, int y) {
  const auto at = [&](int plane, int row, int offset) {
    const Plane& p = image.planes[static_cast<std::size_t>(plane)];
    return static_cast<double>(p.data[static_cast<std::ptrdiff_t>(row) * p.stride_bytes + offset]);
  };
  double luma = 0;
  double u = 128;
  double v = 128;
  const auto whole = [](double value) { return static_cast<int>(std::lround(value)); };
  switch (image.format) {
    case PixelFormat::kRgb24:
      return {whole(at(0, y, 3 * x)), whole(at(0, y, 3 * x + 1)), whole(at(0, y, 3 * x + 2))};
    case PixelFormat::kBgr24:
      return {whole(at(0, y, 3 * x + 2)), whole(at(0, y, 3 * x + 1)), whole(at(0, y, 3 * x))};
    case PixelFormat::kGrey8: {
      const int grey = whole(at(0, y, x));
      return {grey, grey, grey};
    }
    case PixelFormat::kYuyv:
      luma = at(0, y, 2 * x);
      u = at(0, y, x / 2 * 4 + 1);
      v = at(0, y, x / 2 * 4 + 3);
      break;
    case PixelFormat::kNv12:
      luma = at(0, y, x);
      u = at(1, y / 2, x / 2 * 2);
      v = at(1, y / 2, x / 2 * 2 + 1);
      break;
    case PixelFormat::kI420:
      luma = at(0, y, x);
      u = at(1, y / 2, x / 2);
      v = at(2, y / 2, x / 2);
      break;
  }
  const bool full = image.encoding == YuvEncoding::kBt601Full;
  const double l = full ? luma : (luma - 16) * 255 / 219;
  const double chroma = full ? 1 : 255.0 / 224;
  const auto byte = [&](double value) { return std::clamp(whole(value), 0, 255); };
  return {byte(l + 1.402 * chroma * (v - 128)),
          byte(l - chroma * (0.344136 * (u - 128) + 0.714136 * (v - 128))),
          byte(l + 1.772 * chroma * (u - 128))};
}

// 75 % of 255, from the left: white, yellow, cyan, green, magenta, red, blue, black.
constexpr std::array<Rgb, 8> kBars = {{{191, 191, 191},
                                       {191, 191, 0},
                                       {0, 191, 191},
                                       {0, 191, 0},
                                       {191, 0, 191},
                                       {191, 0, 0},
                                       {0, 0, 191},
                                       {0, 0, 0}}};

int FarthestApart(const Rgb& a, const Rgb& b) {
  return std::max({std::abs(a.r - b.r), std::abs(a.g - b.g), std::abs(a.b - b.b)});
}

// Every row, at the picture's edges and in the middle of the bars: a wrong stride, plane or range
// shows in one of them. Rounding alone is worth 3. Grey is whatever a driver takes it to be;
// vivid's is the luma of ITU-R BT.709 from 0 to 255.
void ExpectBars(const ImageView& image) {
  const int bar = image.width_px / 8;
  int worst = 0;
  for (int y = 0; y < image.height_px; ++y) {
    for (int i = 0; i < 8; ++i) {
      const Rgb& colour = kBars[static_cast<std::size_t>(i)];
      const auto brightness =
          static_cast<int>(std::lround(0.2126 * colour.r + 0.7152 * colour.g + 0.0722 * colour.b));
      const Rgb expected =
          image.format == PixelFormat::kGrey8 ? Rgb{brightness, brightness, brightness} : colour;
      const int x = i == 0 ? 0 : i == 7 ? image.width_px - 1 : i * bar + bar / 2;
      worst = std::max(worst, FarthestApart(Seen(image, x, y), expected));
    }
  }
  EXPECT_LE(worst, 3);
}

TEST_F(VividCameraTest, ShowsTheSamePictureInEveryFormat) {
  for (const hal::CameraFormat format : hal::kEveryCameraFormat) {
    if (format == hal::CameraFormat::kMjpeg) continue;  // vivid has none
    V4l2Config config = Config();
    config.formats = {format};
    V4l2Camera camera(config, clock);
    SCOPED_TRACE(hal::v4l2::FourccText(hal::v4l2::FourccOf(format)).data());
    ASSERT_TRUE(camera.Start()) << camera.reason();
    const Result<Frame> frame = camera.Acquire(kAmple);
    ASSERT_TRUE(frame) << camera.reason();
    EXPECT_EQ(frame->image.format, hal::PixelFormatOf(format));
    EXPECT_EQ(frame->image.width_px, 640);
    EXPECT_EQ(frame->image.height_px, 480);
    ExpectBars(frame->image);
    camera.Release(*frame);
  }
}

TEST_F(VividCameraTest, TheFirstFormatIsTakenAtTheDriversNearestRate) {
  V4l2Camera camera = Make();
  ASSERT_TRUE(camera.Start()) << camera.reason();
  EXPECT_EQ(camera.mode().layout.view.format, PixelFormat::kYuyv);
  EXPECT_NEAR(camera.mode().fps, 25, 0.01);  // 30 only for smaller pictures
  EXPECT_EQ(camera.Describe().substr(0, 13), "vivid (vivid)");
}

TEST_F(VividCameraTest, ASizeThatTheDriverDoesNotHaveGivesTheNearest) {
  V4l2Config config = Config();
  config.width_px = 700;
  config.height_px = 500;
  V4l2Camera camera(config, clock);
  ASSERT_TRUE(camera.Start()) << camera.reason();
  EXPECT_EQ(camera.mode().layout.view.width_px, 640);
  EXPECT_EQ(camera.mode().layout.view.height_px, 480);
  ExpectFrames(camera);
}

TEST_F(VividCameraTest, ThreeHundredFramesRiseInNumberAndTimeAndAreFresh) {
  V4l2Camera camera = Make();
  ASSERT_TRUE(camera.Start()) << camera.reason();
  Frame first;
  Frame last;
  for (int i = 0; i < 300; ++i) {
    const Result<Frame> frame = camera.Acquire(kAmple);
    ASSERT_TRUE(frame) << camera.reason();
    const Duration age = clock.Now() - frame->captured;
    EXPECT_GE(age, Duration::zero());
    EXPECT_LT(age, milliseconds(200));
    if (i == 0) {
      EXPECT_EQ(frame->seq, 0U);
      first = *frame;
    } else {
      EXPECT_GT(frame->seq, last.seq);
      EXPECT_GT(frame->captured, last.captured);
    }
    last = *frame;
    camera.Release(*frame);
  }
  // vivid counts the pictures that are due, taken or not.
  const double seconds_passed =
      1e-6 * static_cast<double>((last.captured - first.captured).count());
  EXPECT_NEAR(static_cast<double>(last.seq - first.seq) / seconds_passed, camera.mode().fps, 0.3);
  EXPECT_EQ(camera.stats().frames, 300U);
  EXPECT_EQ(camera.stats().damaged, 0U);
  RecordProperty("gaps", static_cast<int>(last.seq) - 299);
}

TEST_F(VividCameraTest, DroppedPicturesShowAsGaps) {
  V4l2Camera camera = Make();
  vivid.Set("Percentage of Dropped Buffers", 50);
  ASSERT_TRUE(camera.Start()) << camera.reason();
  std::uint64_t last = 0;
  for (int i = 0; i < 40; ++i) {
    const Result<Frame> frame = camera.Acquire(kAmple);
    ASSERT_TRUE(frame) << camera.reason();
    last = frame->seq;
    camera.Release(*frame);
  }
  EXPECT_GT(last, 50U);  // of 40 taken; 80 on average
}

TEST_F(VividCameraTest, ACounterThatStartsAnewDoesNotStepBack) {
  V4l2Camera camera = Make();
  vivid.Set("Wrap Sequence Number", 1);  // the driver starts 128 below the end of its 32 bits
  ASSERT_TRUE(camera.Start()) << camera.reason();
  std::uint64_t last = 0;
  for (int i = 0; i < 200; ++i) {
    const Result<Frame> frame = camera.Acquire(kAmple);
    ASSERT_TRUE(frame) << camera.reason();
    ASSERT_TRUE(i == 0 || frame->seq > last) << frame->seq << " after " << last;
    last = frame->seq;
    camera.Release(*frame);
  }
  EXPECT_LT(last, 1000U);
}

TEST_F(VividCameraTest, ADamagedPictureIsDroppedAndCounted) {
  V4l2Camera camera = Make();
  ASSERT_TRUE(camera.Start()) << camera.reason();
  ExpectFrames(camera);
  vivid.Set("Inject V4L2_BUF_FLAG_ERROR");
  ExpectFrames(camera);
  EXPECT_EQ(camera.stats().damaged, 1U);
}

TEST_F(VividCameraTest, AHeldFrameStaysAsItIsWhileOthersArrive) {
  V4l2Camera camera = Make();
  ASSERT_TRUE(camera.Start()) << camera.reason();
  const Result<Frame> held = camera.Acquire(kAmple);
  ASSERT_TRUE(held);
  vivid.Set("Test Pattern", kWhite);
  std::this_thread::sleep_for(milliseconds(300));
  ExpectBars(held->image);
  camera.Release(*held);
  // What waited in the driver all the while is not shown: only the newest is.
  const Result<Frame> fresh = camera.Acquire(kAmple);
  ASSERT_TRUE(fresh);
  EXPECT_GT(camera.stats().superseded, 0U);
  EXPECT_GT(Seen(fresh->image, 639, 240).r, 250);
  camera.Release(*fresh);
}

TEST_F(VividCameraTest, ASecondOpenerIsBusyAndDoesNotDisturbTheFirst) {
  V4l2Camera first = Make();
  ASSERT_TRUE(first.Start()) << first.reason();
  ExpectFrames(first);
  EXPECT_EQ(StartError(Config(), "another program is using the camera"), Errc::kBusy);
  V4l2Config smaller = Config();
  smaller.width_px = 320;
  smaller.height_px = 180;
  EXPECT_EQ(StartError(smaller, "another program is using the camera"), Errc::kBusy);
  ExpectFrames(first);
  first.Stop();
  V4l2Camera second = Make();
  EXPECT_TRUE(second.Start()) << second.reason();
}

TEST_F(VividCameraTest, StopsAndStartsAgainAsOftenAsWanted) {
  V4l2Camera camera = Make();
  for (int round = 0; round < 10; ++round) {
    ASSERT_TRUE(camera.Start()) << camera.reason();
    const Result<Frame> frame = camera.Acquire(kAmple);
    ASSERT_TRUE(frame) << camera.reason();
    EXPECT_EQ(frame->seq, 0U);
    if (round % 2 == 0) camera.Release(*frame);  // stopping takes back a frame that is still out
    camera.Stop();
    EXPECT_EQ(camera.Acquire(kAmple).error(), Errc::kDisconnected);
  }
}

TEST_F(VividCameraTest, NodesThatAreNoCameraAreUnsupported) {
  const struct {
    const char* name;
    const char* reason;
  } rows[] = {
      {"vivid-000-vid-out", "captures no pictures"},
      {"vivid-000-vbi-cap", "captures no pictures"},
      {Vivid::kPlanesCapture, "captures only into several planes"},
  };
  for (const auto& row : rows) {
    V4l2Config config = Config();
    config.device = VideoNode(row.name);
    ASSERT_NE(config.device, "") << row.name;
    EXPECT_EQ(StartError(config, row.reason), Errc::kUnsupported) << row.name;
  }
  V4l2Config config = Config();
  config.device = "/dev/null";
  EXPECT_EQ(StartError(config, "not a video device"), Errc::kUnsupported);
  config.device = "/dev/video77";
  EXPECT_EQ(StartError(config, "no such device"), Errc::kNotFound);
}

TEST_F(VividCameraTest, AnInterlacedTunerIsRefused) {
  vivid.SelectInput(1);
  EXPECT_EQ(StartError(Config(), "interlaced"), Errc::kUnsupported);
}

TEST_F(VividCameraTest, ACameraThatIsTooSlowIsRefusedWithItsRate) {
  V4l2Config config = Config();
  config.width_px = 3840;
  config.height_px = 2160;
  EXPECT_EQ(StartError(config, "ask for a smaller picture"), Errc::kUnsupported);
}

TEST_F(VividCameraTest, AStreamThatWillNotStartMayBeTriedAgain) {
  V4l2Camera camera = Make();
  for (const char* step : {"Inject VIDIOC_REQBUFS Error", "Inject VIDIOC_QBUF Error",
                           "Inject VIDIOC_STREAMON Error"}) {
    SCOPED_TRACE(step);
    vivid.Set(step);
    EXPECT_FALSE(camera.Start());
    EXPECT_FALSE(camera.reason().empty());
    ASSERT_TRUE(camera.Start()) << camera.reason();
    ExpectFrames(camera);
    camera.Stop();
  }
}

TEST_F(VividCameraTest, AStreamThatBreaksDownIsAnErrorAndStartsAgain) {
  V4l2Camera camera = Make();
  ASSERT_TRUE(camera.Start()) << camera.reason();
  ExpectFrames(camera);
  vivid.Set("Inject Fatal Streaming Error");
  EXPECT_EQ(UntilFailure(camera), Errc::kIo);
  camera.Stop();
  ASSERT_TRUE(camera.Start()) << camera.reason();
  ExpectFrames(camera);
}

TEST_F(VividCameraTest, ADriverThatDisconnectsInMidStreamIsGoneUntilItIsBack) {
  V4l2Camera camera = Make();
  ASSERT_TRUE(camera.Start()) << camera.reason();
  ExpectFrames(camera);
  hal::posix::UniqueFd another = vivid.Open();  // vivid comes back when the last program lets go
  vivid.Set("Disconnect");
  EXPECT_EQ(UntilFailure(camera), Errc::kDisconnected);
  EXPECT_EQ(camera.Acquire(kAmple).error(), Errc::kDisconnected);
  EXPECT_EQ(camera.Start().error(), Errc::kNotFound) << camera.reason();
  another.Reset();
  ASSERT_TRUE(camera.Start()) << camera.reason();
  ExpectFrames(camera);
}

TEST_F(VividCameraTest, ACameraPulledOutInMidStreamIsGoneUntilItIsBack) {
  V4l2Camera camera = Make();
  ASSERT_TRUE(camera.Start()) << camera.reason();
  ExpectFrames(camera);
  vivid.Unplug();
  EXPECT_EQ(UntilFailure(camera), Errc::kDisconnected);
  EXPECT_EQ(camera.Start().error(), Errc::kNotFound) << camera.reason();
  vivid.Plug();
  ASSERT_TRUE(camera.Start()) << camera.reason();
  ExpectFrames(camera);
}

TEST_F(VividCameraTest, AFrameHeldWhileTheCameraIsPulledOutStaysReadable) {
  V4l2Camera camera = Make();
  ASSERT_TRUE(camera.Start()) << camera.reason();
  const Result<Frame> held = camera.Acquire(kAmple);
  ASSERT_TRUE(held);
  vivid.Unplug();
  ExpectBars(held->image);
  camera.Release(*held);
  EXPECT_EQ(UntilFailure(camera), Errc::kDisconnected);
  vivid.Plug();
  ASSERT_TRUE(camera.Start()) << camera.reason();
}

TEST_F(VividCameraTest, PullingTheCameraOutEndsAWaitAtOnce) {
  V4l2Config config = Config();
  config.fps = 1;  // so that the wait is under way
  config.lowest_fps = 1;
  V4l2Camera camera(config, clock);
  ASSERT_TRUE(camera.Start()) << camera.reason();
  ExpectFrames(camera, 1);
  std::thread hand([] {
    std::this_thread::sleep_for(milliseconds(100));
    Vivid::Unplug();
  });
  const Time before = clock.Now();
  const Result<Frame> frame = camera.Acquire(seconds(60));
  const Duration waited = clock.Now() - before;
  hand.join();
  EXPECT_EQ(frame.error(), Errc::kDisconnected);
  EXPECT_LT(waited, milliseconds(900));
  vivid.Plug();
}

TEST_F(VividCameraTest, ARefusedStartAndAnUnpluggingLeaveNoFileOpen) {
  const auto open_files = [] {
    return std::distance(std::filesystem::directory_iterator("/proc/self/fd"), {});
  };
  V4l2Camera camera = Make();
  const auto before = open_files();
  vivid.SelectInput(1);
  EXPECT_FALSE(camera.Start());
  vivid.SelectInput(0);
  EXPECT_EQ(open_files(), before);
  ASSERT_TRUE(camera.Start()) << camera.reason();
  vivid.Unplug();
  EXPECT_EQ(UntilFailure(camera), Errc::kDisconnected);
  EXPECT_EQ(open_files(), before);
  vivid.Plug();
}

}  // namespace
}  // namespace facewire::devices
