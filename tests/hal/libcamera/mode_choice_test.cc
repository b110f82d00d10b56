#include "hal/libcamera/mode_choice.h"

#include <gtest/gtest.h>

#include <chrono>
#include <limits>

namespace facewire::hal::libcamera {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr CameraFormat kYuyv = CameraFormat::kYuyv;
constexpr CameraFormat kMjpeg = CameraFormat::kMjpeg;
constexpr CameraFormat kGrey = CameraFormat::kGrey8;

TEST(ChooseMode, TakesTheFirstPreferredFormatThatHasTheSize) {
  const Mode offered[] = {{kMjpeg, 640, 480}, {kYuyv, 640, 480}, {kYuyv, 1280, 720}};
  const CameraFormat preferred[] = {kYuyv, kMjpeg};
  EXPECT_EQ(ChooseMode(offered, preferred, 640, 480), (Mode{kYuyv, 640, 480}));
}

TEST(ChooseMode, PutsTheSizeBeforeTheFormat) {
  const Mode offered[] = {{kYuyv, 320, 240}, {kMjpeg, 640, 480}};
  const CameraFormat preferred[] = {kYuyv, kMjpeg};
  EXPECT_EQ(ChooseMode(offered, preferred, 640, 480), (Mode{kMjpeg, 640, 480}));
}

TEST(ChooseMode, TakesTheNearestSizeOfTheBestFormatWhenNoneHasTheSize) {
  const Mode offered[] = {{kMjpeg, 640, 400}, {kYuyv, 320, 240}, {kYuyv, 800, 600}};
  const CameraFormat preferred[] = {kGrey, kYuyv, kMjpeg};
  EXPECT_EQ(ChooseMode(offered, preferred, 640, 480), (Mode{kYuyv, 800, 600}));
}

TEST(ChooseMode, TakesNothingThatNobodyPrefers) {
  const Mode offered[] = {{kMjpeg, 640, 480}};
  const CameraFormat preferred[] = {kYuyv};
  EXPECT_FALSE(ChooseMode(offered, preferred, 640, 480));
  EXPECT_FALSE(ChooseMode({}, preferred, 640, 480));
}

TEST(Describe, NamesFormatAndSize) { EXPECT_EQ(Describe({kMjpeg, 1280, 720}), "mjpeg 1280x720"); }

TEST(ChooseFrameDuration, StaysWithinWhatTheCameraCanDo) {
  EXPECT_EQ(ChooseFrameDuration(30, 1000, 1'000'000), 33333);
  EXPECT_EQ(ChooseFrameDuration(30, 40'000, 1'000'000), 40'000);
  EXPECT_EQ(ChooseFrameDuration(30, 1000, 20'000), 20'000);
  // A camera that contradicts itself.
  EXPECT_EQ(ChooseFrameDuration(30, 50'000, 0), 50'000);
}

TEST(CaptureTime, IsTheCamerasStampInMicroseconds) {
  const Time now{seconds(100)};
  EXPECT_EQ(CaptureTime(99'950'000'999, now), Time{milliseconds(99'950)});
}

TEST(CaptureTime, MayLieALittleAhead) {
  const Time now{seconds(100)};
  EXPECT_EQ(CaptureTime(100'020'000'000, now), Time{milliseconds(100'020)});
}

TEST(CaptureTime, IsNowWhenTheStampIsOfAnotherClock) {
  const Time now{seconds(100)};
  for (const std::uint64_t stamp_ns :
       {std::uint64_t{0}, std::uint64_t{89'000'000'000}, std::uint64_t{111'000'000'000},
        std::uint64_t{1'700'000'000'000'000'000}, std::numeric_limits<std::uint64_t>::max()}) {
    EXPECT_EQ(CaptureTime(stamp_ns, now), now) << stamp_ns;
  }
}

TEST(FrameCount, BeginsAtZeroAndKeepsTheGaps) {
  FrameCount count;
  EXPECT_EQ(count.Next(17), 0U);
  EXPECT_EQ(count.Next(18), 1U);
  EXPECT_EQ(count.Next(21), 4U);
  count.Reset();
  EXPECT_EQ(count.Next(99), 0U);
}

TEST(FrameCount, GoesOnBeyond32Bits) {
  FrameCount count;
  count.Next(0xFFFFFFFEU);
  EXPECT_EQ(count.Next(1), 3U);
}

TEST(FrameCount, DoesNotStepBackWithACameraThatBeginsAnew) {
  FrameCount count;
  count.Next(500);
  count.Next(501);
  EXPECT_EQ(count.Next(501), 2U);  // repeated
  EXPECT_EQ(count.Next(0), 3U);
  EXPECT_EQ(count.Next(1), 4U);
}

}  // namespace
}  // namespace facewire::hal::libcamera
