#include "hal/fake/fake_camera.h"

#include <gtest/gtest.h>

#include <array>

#include "hal/fake/fake_clock.h"

namespace facewire::hal::fake {
namespace {

using std::chrono::milliseconds;

// Three grey pictures of one pixel with the values 0, 1, 2, at 100 frames a second.
struct Context {
  std::array<std::uint8_t, 3> pixels = {0, 1, 2};
  std::array<ImageView, 3> pictures = [this] {
    std::array<ImageView, 3> views;
    for (std::size_t i = 0; i < views.size(); ++i) {
      views[i].width_px = views[i].height_px = 1;
      views[i].planes[0] = {.data = &pixels[i], .stride_bytes = 1};
    }
    return views;
  }();
  FakeClock clock{Time{milliseconds(1000)}};

  FakeCamera Make(LoopMode loop = LoopMode::kRestart, Pace pace = Pace::kRealTime) {
    return {{.pictures = pictures, .fps = 100, .pace = pace, .loop = loop}, clock};
  }
};

int Value(const Frame& frame) { return *frame.image.planes[0].data; }

TEST(FakeCamera, ShowsPicturesAtTheirTimes) {
  Context context;
  FakeCamera camera = context.Make();
  ASSERT_TRUE(camera.Start());
  for (int n = 0; n < 7; ++n) {
    const Result<Frame> frame = camera.Acquire(milliseconds(20));
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->seq, static_cast<std::uint64_t>(n));
    EXPECT_EQ(frame->captured, Time{milliseconds(1000 + 10 * n)});
    EXPECT_EQ(context.clock.Now(), frame->captured);
    EXPECT_EQ(Value(*frame), n % 3);
    camera.Release(*frame);
  }
}

TEST(FakeCamera, ASlowCallerGetsTheNewestFrameAndSeesTheGap) {
  Context context;
  FakeCamera camera = context.Make();
  ASSERT_TRUE(camera.Start());
  ASSERT_TRUE(camera.Acquire(milliseconds(20)));
  context.clock.Advance(milliseconds(45));
  const Result<Frame> frame = camera.Acquire(milliseconds(20));
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->seq, 4U);
  EXPECT_EQ(frame->captured, Time{milliseconds(1040)});
}

TEST(FakeCamera, AFrameThatIsNotDueInTimeIsATimeout) {
  Context context;
  FakeCamera camera = context.Make();
  ASSERT_TRUE(camera.Start());
  ASSERT_TRUE(camera.Acquire(milliseconds(20)));
  EXPECT_EQ(camera.Acquire(milliseconds(9)).error(), Errc::kTimeout);
  EXPECT_TRUE(camera.Acquire(milliseconds(1)));
}

TEST(FakeCamera, SilenceTimesOutAndItsFramesAreMissed) {
  Context context;
  FakeCamera camera = context.Make();
  ASSERT_TRUE(camera.Start());
  ASSERT_TRUE(camera.Acquire(milliseconds(20)));
  camera.FallSilent();
  EXPECT_EQ(camera.Acquire(milliseconds(500)).error(), Errc::kTimeout);
  EXPECT_EQ(context.clock.Now(), Time{milliseconds(1500)});
  camera.Resume();
  EXPECT_EQ(camera.Acquire(milliseconds(20))->seq, 50U);
}

TEST(FakeCamera, GoesAndComesBack) {
  Context context;
  FakeCamera camera = context.Make();
  ASSERT_TRUE(camera.Start());
  camera.Unplug();
  EXPECT_EQ(camera.Acquire(milliseconds(20)).error(), Errc::kDisconnected);
  EXPECT_EQ(camera.Start().error(), Errc::kNotFound);
  camera.Plug();
  ASSERT_TRUE(camera.Start());
  EXPECT_EQ(camera.Acquire(milliseconds(20))->seq, 0U);
}

TEST(FakeCamera, EndsWithItsScriptOrWhenTold) {
  Context context;
  FakeCamera camera = context.Make(LoopMode::kNone, Pace::kFast);
  ASSERT_TRUE(camera.Start());
  for (int n = 0; n < 3; ++n) EXPECT_EQ(Value(*camera.Acquire(milliseconds(0))), n);
  EXPECT_EQ(camera.Acquire(milliseconds(0)).error(), Errc::kEnd);
  camera.Stop();
  ASSERT_TRUE(camera.Start());
  ASSERT_TRUE(camera.Acquire(milliseconds(0)));
  camera.End();
  EXPECT_EQ(camera.Acquire(milliseconds(0)).error(), Errc::kEnd);
}

TEST(FakeCamera, StartFailsAsOftenAsTold) {
  Context context;
  FakeCamera camera = context.Make();
  camera.FailStarts(1, Errc::kBusy);
  EXPECT_EQ(camera.Start().error(), Errc::kBusy);
  EXPECT_TRUE(camera.Start());
}

TEST(FakeCamera, RefusesAnEmptyScriptAndAnImpossibleRate) {
  Context context;
  EXPECT_EQ(FakeCamera({.pictures = {}}, context.clock).Start().error(), Errc::kInvalidArgument);
  EXPECT_EQ(FakeCamera({.pictures = context.pictures, .fps = 0}, context.clock).Start().error(),
            Errc::kInvalidArgument);
}

TEST(FakeCamera, CountsFramesThatWereNotGivenBack) {
  Context context;
  FakeCamera camera = context.Make();
  ASSERT_TRUE(camera.Start());
  const Result<Frame> frame = camera.Acquire(milliseconds(20));
  ASSERT_TRUE(frame);
  EXPECT_EQ(camera.outstanding(), 1);
  camera.Release(*frame);
  EXPECT_EQ(camera.outstanding(), 0);
}

TEST(FakeCamera, CountsDamagedPicturesSinceItsStart) {
  Context context;
  FakeCamera camera = context.Make();
  ASSERT_TRUE(camera.Start());
  EXPECT_EQ(camera.counts().damaged, 0U);
  camera.Damage(3);
  EXPECT_EQ(camera.counts().damaged, 3U);
  camera.Stop();
  ASSERT_TRUE(camera.Start());
  EXPECT_EQ(camera.counts().damaged, 0U);
}

}  // namespace
}  // namespace facewire::hal::fake
