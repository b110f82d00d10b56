#include "hal/replay/replay_camera.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <opencv2/core.hpp>
#include <opencv2/videoio.hpp>
#include <string>

#include "hal/fake/fake_clock.h"
#include "tests/hal/far_end.h"
#include "tests/support/allocation_counter.h"

namespace facewire::hal::replay {
namespace {

using std::chrono::milliseconds;
using test::TemporaryFolder;

constexpr int kWidth = 64;
constexpr int kHeight = 48;
constexpr std::size_t kFrameBytes = std::size_t{3} * kWidth * kHeight;
constexpr int kFrames = 20;

// A clip of kFrames at 25 fps whose frames tell their number: frame n is a plane of grey 10 n + 20.
class ReplayCameraTest : public ::testing::Test {
 protected:
  ReplayCameraTest() : clip_(folder_.File("clip.avi")) {
    cv::VideoWriter writer(clip_, cv::CAP_OPENCV_MJPEG, cv::VideoWriter::fourcc('M', 'J', 'P', 'G'),
                           25, {kWidth, kHeight});
    for (int n = 0; n < kFrames; ++n) {
      writer.write(cv::Mat(kHeight, kWidth, CV_8UC3, cv::Scalar::all(10 * n + 20)));
    }
  }
  ReplayConfig Config(std::size_t frames_in_memory = 0, LoopMode loop = LoopMode::kNone,
                      Pace pace = Pace::kFast) const {
    return {
        .path = clip_, .pace = pace, .loop = loop, .memory_bytes = frames_in_memory * kFrameBytes};
  }

  TemporaryFolder folder_;
  std::string clip_;
  fake::FakeClock clock_{Time{milliseconds(7000)}};
};

// Which frame of the clip this is, by the pixel in its middle.
int Number(const Frame& frame) {
  const Plane& plane = frame.image.planes[0];
  const int grey = plane.data[kHeight / 2 * plane.stride_bytes + 3 * (kWidth / 2)];
  return (grey - 20 + 5) / 10;
}

// The numbers of the next frames, until the end or `most`.
std::vector<int> Play(ReplayCamera& camera, std::size_t most = 1000) {
  std::vector<int> numbers;
  while (numbers.size() < most) {
    const Result<Frame> frame = camera.Acquire(milliseconds(1000));
    if (!frame) break;
    numbers.push_back(Number(*frame));
    camera.Release(*frame);
  }
  return numbers;
}

std::vector<int> Numbers(int first, int end) {
  std::vector<int> numbers;
  for (int n = first; n < end; ++n) numbers.push_back(n);
  return numbers;
}

TEST_F(ReplayCameraTest, StreamsEveryFrameOnceInOrder) {
  ReplayCamera camera(Config(), clock_);
  ASSERT_TRUE(camera.Start());
  EXPECT_EQ(Play(camera), Numbers(0, kFrames));
  EXPECT_EQ(camera.Acquire(milliseconds(0)).error(), Errc::kEnd);
  EXPECT_EQ(camera.Acquire(milliseconds(0)).error(), Errc::kEnd);
}

TEST_F(ReplayCameraTest, SaysWhatItFound) {
  ReplayCamera camera(Config(6), clock_);
  ASSERT_TRUE(camera.Start());
  const ReplayInfo& info = camera.info();
  EXPECT_EQ(info.width_px, kWidth);
  EXPECT_EQ(info.height_px, kHeight);
  EXPECT_DOUBLE_EQ(info.fps, 25);
  EXPECT_FALSE(info.fps_assumed);
  EXPECT_EQ(info.frames_in_file, static_cast<std::uint64_t>(kFrames));
  EXPECT_EQ(info.frames_held, 6U);
  EXPECT_EQ(info.block_bytes, 6 * kFrameBytes);
}

TEST_F(ReplayCameraTest, FramesArePackedBgrWithMediaTimeWhenFast) {
  ReplayCamera camera(Config(), clock_);
  ASSERT_TRUE(camera.Start());
  for (int n = 0; n < 3; ++n) {
    const Result<Frame> frame = camera.Acquire(milliseconds(0));
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->image.format, PixelFormat::kBgr24);
    EXPECT_EQ(frame->image.width_px, kWidth);
    EXPECT_EQ(frame->image.height_px, kHeight);
    EXPECT_EQ(frame->image.planes[0].stride_bytes, 3 * kWidth);
    EXPECT_EQ(frame->captured, Time{milliseconds(40 * n)});
  }
}

TEST_F(ReplayCameraTest, MemoryHoldsWhatFitsAndEndsThere) {
  ReplayCamera camera(Config(6), clock_);
  ASSERT_TRUE(camera.Start());
  EXPECT_EQ(Play(camera), Numbers(0, 6));
  EXPECT_EQ(camera.Acquire(milliseconds(0)).error(), Errc::kEnd);
}

TEST_F(ReplayCameraTest, MemoryTakesNoMoreThanTheClipNeeds) {
  ReplayCamera camera(Config(1000), clock_);
  ASSERT_TRUE(camera.Start());
  EXPECT_EQ(camera.info().block_bytes, kFrames * kFrameBytes);
  EXPECT_EQ(Play(camera), Numbers(0, kFrames));
}

TEST_F(ReplayCameraTest, MemoryForLessThanOneFrameIsFullAndSaysHowMuchItTakes) {
  ReplayConfig config = Config();
  config.memory_bytes = kFrameBytes - 1;
  ReplayCamera camera(config, clock_);
  EXPECT_EQ(camera.Start().error(), Errc::kFull);
  EXPECT_EQ(camera.info().frame_bytes, kFrameBytes);
  EXPECT_EQ(camera.Acquire(milliseconds(0)).error(), Errc::kDisconnected);
}

TEST_F(ReplayCameraTest, LoopsInEveryMode) {
  ReplayCamera restart(Config(3, LoopMode::kRestart), clock_);
  ASSERT_TRUE(restart.Start());
  EXPECT_EQ(Play(restart, 7), (std::vector{0, 1, 2, 0, 1, 2, 0}));

  ReplayCamera back_and_forth(Config(3, LoopMode::kPingPong), clock_);
  ASSERT_TRUE(back_and_forth.Start());
  EXPECT_EQ(Play(back_and_forth, 7), (std::vector{0, 1, 2, 1, 0, 1, 2}));

  ReplayCamera streamed(Config(0, LoopMode::kRestart), clock_);
  ASSERT_TRUE(streamed.Start());
  std::vector<int> twice = Numbers(0, kFrames);
  for (int n = 0; n < kFrames; ++n) twice.push_back(n);
  EXPECT_EQ(Play(streamed, twice.size()), twice);
}

TEST_F(ReplayCameraTest, SequenceAndTimeGoOnThroughLoops) {
  for (const std::size_t in_memory : {std::size_t{0}, std::size_t{4}}) {
    for (const Pace pace : {Pace::kFast, Pace::kRealTime}) {
      ReplayCamera camera(Config(in_memory, LoopMode::kRestart, pace), clock_);
      ASSERT_TRUE(camera.Start());
      const Time start = pace == Pace::kFast ? Time{} : clock_.Now();
      for (std::uint64_t n = 0; n < 50; ++n) {
        const Result<Frame> frame = camera.Acquire(milliseconds(40));
        ASSERT_TRUE(frame);
        EXPECT_EQ(frame->seq, n);
        EXPECT_EQ(frame->captured, start + milliseconds(40) * n);
      }
    }
  }
}

TEST_F(ReplayCameraTest, BackAndForthNeedsABlock) {
  ReplayCamera camera(Config(0, LoopMode::kPingPong), clock_);
  EXPECT_EQ(camera.Start().error(), Errc::kInvalidArgument);
}

TEST_F(ReplayCameraTest, RealTimeWaitsUntilAFrameIsDue) {
  for (const std::size_t in_memory : {0, 20}) {
    ReplayCamera camera(Config(in_memory, LoopMode::kNone, Pace::kRealTime), clock_);
    ASSERT_TRUE(camera.Start());
    const Time start = clock_.Now();
    ASSERT_TRUE(camera.Acquire(milliseconds(0)));
    EXPECT_EQ(camera.Acquire(milliseconds(39)).error(), Errc::kTimeout);
    const Result<Frame> frame = camera.Acquire(milliseconds(1));
    ASSERT_TRUE(frame);
    EXPECT_EQ(Number(*frame), 1);
    EXPECT_EQ(clock_.Now(), start + milliseconds(40));
  }
}

TEST_F(ReplayCameraTest, RealTimeDropsWhatIsLateAndShowsTheGap) {
  for (const std::size_t in_memory : {0, 20}) {
    ReplayCamera camera(Config(in_memory, LoopMode::kNone, Pace::kRealTime), clock_);
    ASSERT_TRUE(camera.Start());
    ASSERT_TRUE(camera.Acquire(milliseconds(40)));
    clock_.Advance(milliseconds(410));
    const Result<Frame> frame = camera.Acquire(milliseconds(40));
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->seq, 10U);
    EXPECT_EQ(Number(*frame), 10);
    clock_.Advance(milliseconds(10000));
    EXPECT_EQ(camera.Acquire(milliseconds(40)).error(), Errc::kEnd);
  }
}

TEST_F(ReplayCameraTest, StartsAgainFromTheBeginning) {
  for (const std::size_t in_memory : {0, 20}) {
    ReplayCamera camera(Config(in_memory), clock_);
    for (int round = 0; round < 2; ++round) {
      ASSERT_TRUE(camera.Start());
      EXPECT_EQ(Play(camera, 3), Numbers(0, 3));
      camera.Stop();
      EXPECT_EQ(camera.Acquire(milliseconds(0)).error(), Errc::kDisconnected);
    }
  }
}

TEST_F(ReplayCameraTest, FromMemoryNothingAllocatesAndNoThreadIsLeft) {
  using facewire::test::AllocationCounter;
  if (!AllocationCounter::kAvailable) GTEST_SKIP() << AllocationCounter::kWhyNot;
  const auto threads = [] {
    using It = std::filesystem::directory_iterator;
    return std::distance(It("/proc/self/task"), It());
  };
  ReplayCamera camera(Config(kFrames, LoopMode::kRestart), clock_);
  const auto before = threads();
  ASSERT_TRUE(camera.Start());
  EXPECT_EQ(threads(), before);
  AllocationCounter counter;
  counter.Arm();
  int got = 0;
  for (int n = 0; n < 10 * kFrames; ++n) {
    const Result<Frame> frame = camera.Acquire(milliseconds(0));
    got += frame ? 1 : 0;
    if (frame) camera.Release(*frame);
  }
  counter.Disarm();
  counter.PrintFirst();
  EXPECT_EQ(got, 10 * kFrames);
  EXPECT_EQ(counter.allocations(), 0U);
  EXPECT_EQ(counter.frees(), 0U);
}

TEST_F(ReplayCameraTest, ACutFilePlaysWhatIsThere) {
  std::filesystem::resize_file(clip_, std::filesystem::file_size(clip_) * 6 / 10);
  for (const std::size_t in_memory : {0, 20}) {
    ReplayCamera camera(Config(in_memory), clock_);
    ASSERT_TRUE(camera.Start());
    const std::vector<int> numbers = Play(camera);
    ASSERT_GT(numbers.size(), 5U);
    ASSERT_LT(numbers.size(), static_cast<std::size_t>(kFrames));
    // The frame at the cut may be damaged; those before it are whole.
    EXPECT_EQ(std::vector<int>(numbers.begin(), numbers.end() - 1),
              Numbers(0, static_cast<int>(numbers.size()) - 1));
  }
}

TEST_F(ReplayCameraTest, RefusesWhatIsNotAVideoWithoutAWordOnStderr) {
  std::ofstream(folder_.File("text.mp4")) << "this is not a video\n";
  std::ofstream(folder_.File("text.txt")) << "nor is this\n";
  std::ofstream(folder_.File("empty.mp4")).flush();
  std::filesystem::copy_file(clip_, folder_.File("headless.avi"));
  std::filesystem::resize_file(folder_.File("headless.avi"), 100);
  testing::internal::CaptureStderr();
  const auto error = [this](const std::string& path) {
    return ReplayCamera({.path = path}, clock_).Start().error();
  };
  EXPECT_EQ(error(folder_.File("missing.mp4")), Errc::kNotFound);
  EXPECT_EQ(error(folder_.File("text.mp4")), Errc::kUnsupported);
  EXPECT_EQ(error(folder_.File("text.txt")), Errc::kUnsupported);
  EXPECT_EQ(error(folder_.File("empty.mp4")), Errc::kUnsupported);
  EXPECT_EQ(error(folder_.File("headless.avi")), Errc::kUnsupported);
  EXPECT_EQ(error("/dev/null"), Errc::kUnsupported);
  EXPECT_EQ(error("/"), Errc::kUnsupported);
  EXPECT_EQ(error("http://127.0.0.1:1/clip.mp4"), Errc::kNotFound);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST(ReplayCamera, PlaysRealFootageOfAFace) {
  const std::string path = FACEWIRE_ASSETS "/footage/franck.mp4";
  fake::FakeClock clock;
  ReplayCamera streamed({.path = path, .pace = Pace::kFast}, clock);
  ASSERT_TRUE(streamed.Start()) << path << " is unpacked by tools/setup";
  const ReplayInfo& info = streamed.info();
  EXPECT_GT(info.frames_in_file, 1200U);
  ReplayCamera held({.path = path, .pace = Pace::kFast, .memory_bytes = 10 * info.frame_bytes},
                    clock);
  ASSERT_TRUE(held.Start());
  EXPECT_EQ(held.info().frames_held, 10U);
  for (int n = 0; n < 10; ++n) {
    const Result<Frame> a = streamed.Acquire(milliseconds(0));
    const Result<Frame> b = held.Acquire(milliseconds(0));
    ASSERT_TRUE(a && b);
    EXPECT_TRUE(std::equal(a->image.planes[0].data, a->image.planes[0].data + info.frame_bytes,
                           b->image.planes[0].data));
  }
}

}  // namespace
}  // namespace facewire::hal::replay
