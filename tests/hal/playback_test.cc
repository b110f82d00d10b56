#include "hal/playback.h"

#include <gtest/gtest.h>

#include <vector>

#include "hal/fake/fake_clock.h"

namespace facewire::hal {
namespace {

using std::chrono::milliseconds;

std::vector<std::uint64_t> Indices(LoopMode mode, std::uint64_t count, std::uint64_t shown) {
  std::vector<std::uint64_t> indices;
  for (std::uint64_t n = 0; n < shown; ++n) indices.push_back(LoopIndex(mode, n, count));
  return indices;
}
using Expected = std::vector<std::uint64_t>;

TEST(LoopIndex, GoesRoundOrBackAndForth) {
  EXPECT_EQ(Indices(LoopMode::kNone, 3, 3), (Expected{0, 1, 2}));
  EXPECT_EQ(Indices(LoopMode::kRestart, 3, 7), (Expected{0, 1, 2, 0, 1, 2, 0}));
  EXPECT_EQ(Indices(LoopMode::kPingPong, 3, 9), (Expected{0, 1, 2, 1, 0, 1, 2, 1, 0}));
}

TEST(LoopIndex, ASinglePictureStays) {
  EXPECT_EQ(Indices(LoopMode::kRestart, 1, 3), (Expected{0, 0, 0}));
  EXPECT_EQ(Indices(LoopMode::kPingPong, 1, 3), (Expected{0, 0, 0}));
}

TEST(Pacer, TimesDoNotDriftWhenThePeriodIsNoWholeNumber) {
  fake::FakeClock clock;
  const Pacer pacer(clock, Pace::kRealTime, 30);
  EXPECT_EQ(pacer.CapturedAt(1), Time{Duration(33333)});
  EXPECT_EQ(pacer.CapturedAt(2), Time{Duration(66667)});
  EXPECT_EQ(pacer.CapturedAt(108000), Time{std::chrono::hours(1)});
}

TEST(Pacer, EveryFrameIsDueExactlyWhenItIsCaptured) {
  fake::FakeClock clock(Time{Duration(123457)});
  for (const double fps : {23.976, 25.0, 29.97, 30.0, 59.94, 240.0}) {
    Pacer pacer(clock, Pace::kRealTime, fps);
    for (std::uint64_t n = 0; n < 2000; ++n) {
      ASSERT_EQ(pacer.Wait(n, milliseconds(100)), n) << fps;
      ASSERT_EQ(clock.Now(), pacer.CapturedAt(n)) << fps;
    }
  }
}

TEST(Pacer, TheNewestFrameThatIsDueWins) {
  fake::FakeClock clock;
  Pacer pacer(clock, Pace::kRealTime, 30);
  clock.Advance(pacer.CapturedAt(1000) - Duration(1) - clock.Now());
  EXPECT_EQ(pacer.Wait(5, milliseconds(0)), 999U);
  clock.Advance(Duration(1));
  EXPECT_EQ(pacer.Wait(5, milliseconds(0)), 1000U);
}

TEST(Pacer, FastNeitherWaitsNorSkips) {
  fake::FakeClock clock(Time{milliseconds(5000)});
  Pacer pacer(clock, Pace::kFast, 25);
  EXPECT_EQ(pacer.Wait(7, milliseconds(0)), 7U);
  EXPECT_EQ(pacer.CapturedAt(7), Time{milliseconds(280)});
  EXPECT_EQ(clock.Now(), Time{milliseconds(5000)});
}

}  // namespace
}  // namespace facewire::hal
