#include "app/watched_camera.h"

#include <gtest/gtest.h>

#include <array>
#include <chrono>

#include "hal/fake/fake_camera.h"
#include "hal/fake/fake_clock.h"

namespace facewire::app {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using Health = WatchedCamera::Health;

constexpr Duration kTick = milliseconds(50);
constexpr Duration kSilence = seconds(1);

class WatchedCameraTest : public testing::Test {
 protected:
  WatchedCameraTest() {
    picture.width_px = picture.height_px = 2;
    picture.planes[0] = {pixels.data(), 2};
    EXPECT_TRUE(camera.Start());
  }
  // One tick: a picture that is given back, or why there was none.
  Result<> Tick() {
    const Time deadline = clock.Now() + kTick;
    const Result<Frame> frame = watched.Wait(deadline, kSilence);
    if (!frame) {
      clock.SleepUntil(deadline);
      return frame.error();
    }
    watched.Release(*frame);
    return {};
  }
  void For(Duration time) {
    for (const Time end = clock.Now() + time; clock.Now() < end;) (void)Tick();
  }

  std::array<std::uint8_t, 4> pixels{};
  ImageView picture;
  hal::fake::FakeClock clock;
  hal::fake::FakeCamera camera{{.pictures = {&picture, 1}}, clock};
  ServiceStats stats;
  WatchedCamera watched{camera, clock, stats};
};

TEST_F(WatchedCameraTest, HandsOnEveryPictureAndCountsIt) {
  for (int i = 0; i < 30; ++i) ASSERT_TRUE(Tick()) << i;
  EXPECT_EQ(stats.frames, 30U);
  EXPECT_EQ(stats.frames_dropped, 0U);
  EXPECT_EQ(camera.outstanding(), 0);
  EXPECT_EQ(watched.last_picture(), clock.Now());
  EXPECT_EQ(watched.health(kSilence), Health::kUp);
}

TEST_F(WatchedCameraTest, CountsPicturesThatNobodySawAndThoseThatCameBroken) {
  ASSERT_TRUE(Tick());
  clock.Advance(milliseconds(400));  // 12 pictures
  camera.Damage(3);
  ASSERT_TRUE(Tick());
  EXPECT_GE(stats.frames_dropped, 10U);
  EXPECT_EQ(stats.frames_damaged, 3U);
}

TEST_F(WatchedCameraTest, WaitsNoLongerThanToTheDeadlineForACameraThatIsSilent) {
  camera.FallSilent();
  const Time deadline = clock.Now() + kTick;
  EXPECT_EQ(watched.Wait(deadline, kSilence).error(), Errc::kTimeout);
  EXPECT_EQ(clock.Now(), deadline);
  EXPECT_TRUE(watched.running());
}

TEST_F(WatchedCameraTest, StartsASilentCameraAgainEverMoreRarely) {
  ASSERT_TRUE(Tick());
  camera.FallSilent();
  For(kSilence - kTick);
  EXPECT_EQ(stats.camera_restarts, 0U);
  EXPECT_EQ(watched.health(kSilence), Health::kUp);
  For(seconds(9));
  const std::uint64_t at_first = stats.camera_restarts;
  EXPECT_GE(at_first, 3U);
  EXPECT_EQ(watched.health(kSilence), Health::kSilent);
  For(seconds(60));
  EXPECT_LE(stats.camera_restarts - at_first, 9U);  // every eight seconds
  EXPECT_EQ(stats.camera_errors, 0U);
  camera.Resume();
  For(seconds(9));
  EXPECT_EQ(watched.health(kSilence), Health::kUp);
}

TEST_F(WatchedCameraTest, StartsACameraAgainThatIsBack) {
  camera.Unplug();
  EXPECT_FALSE(Tick());
  EXPECT_FALSE(watched.running());
  EXPECT_EQ(stats.camera_errors, 1U);
  For(seconds(2));
  EXPECT_EQ(watched.health(kSilence), Health::kGone);
  EXPECT_FALSE(watched.Stuck(kSilence)) << "its absence is known";
  camera.Plug();
  For(Backoff::kLongest);
  EXPECT_TRUE(Tick());
  EXPECT_EQ(watched.health(kSilence), Health::kUp);
}

TEST_F(WatchedCameraTest, ARecordingThatIsOverIsNotStartedAgain) {
  ASSERT_TRUE(Tick());
  camera.End();
  EXPECT_EQ(Tick().error(), Errc::kEnd);
  EXPECT_TRUE(watched.ended());
  For(seconds(20));
  EXPECT_EQ(stats.camera_restarts, 0U);
  EXPECT_FALSE(watched.Stuck(kSilence));
}

TEST_F(WatchedCameraTest, IsStuckWhenItOpensButSendsNothingNew) {
  ASSERT_TRUE(Tick());
  camera.FallSilent();
  For(3 * kSilence);
  EXPECT_FALSE(watched.Stuck(kSilence));
  For(2 * kTick);
  EXPECT_TRUE(watched.Stuck(kSilence));
}

}  // namespace
}  // namespace facewire::app
