#include "core/retarget/steady.h"

#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <cmath>

namespace facewire::retarget {
namespace {

using namespace std::chrono_literals;

struct Context {
  Steady steady;
  std::array<float, 1> range{1};
  Time now{};

  // One frame later.
  float At(float value, Duration step = 33333us) {
    now += step;
    std::array<float, 1> signal{value};
    steady.Update(now, range, signal);
    return signal[0];
  }
};

TEST(Steady, TheFirstValueIsTakenAsItIs) { EXPECT_EQ(Context{}.At(0.7F), 0.7F); }

TEST(Steady, ABlinkPassesInTheSameFrame) {
  Context c;
  c.At(0.1F);
  EXPECT_NEAR(c.At(0.9F), 0.9F, 0.005F);
}

TEST(Steady, AveragesWhatTrembles) {
  Context c;
  float most = 0;
  for (int frame = 0; frame < 300; ++frame) {
    const float value = c.At(frame % 2 == 0 ? 0.49F : 0.51F);
    if (frame > 200) most = std::max(most, std::abs(value - 0.5F));
  }
  EXPECT_LT(most, 0.003F) << "0.01 came in";
}

TEST(Steady, ArrivesWhereverItIsGoing) {
  Context c;
  c.At(0.5F);
  for (int frame = 0; frame < 60; ++frame) c.At(0.54F);
  EXPECT_NEAR(c.At(0.54F), 0.54F, 0.006F);
}

TEST(Steady, TheSameTimeTakesAboutTheSameWayAtAnyRate) {
  Context slow;
  Context fast;
  slow.At(0);
  fast.At(0);
  const float at_30 = slow.At(0.05F, 33333us);
  float at_120 = 0;
  for (int frame = 0; frame < 4; ++frame) at_120 = fast.At(0.05F, 8333us);
  EXPECT_NEAR(at_30, at_120, 0.01F) << "of 0.05";
}

TEST(Steady, NoiseIsAPartOfTheRange) {
  Context degrees;
  degrees.range = {30};
  degrees.At(10);
  EXPECT_LT(degrees.At(10.3F), 10.05F);
  Context none;
  none.range = {0};
  none.At(10);
  EXPECT_EQ(none.At(10.3F), 10.3F);
}

TEST(Steady, AfterASilenceOrAResetOrABackwardStepItStartsAnew) {
  Context c;
  c.At(0);
  EXPECT_EQ(c.At(0.02F, 300ms), 0.02F);
  c.steady.Reset();
  EXPECT_EQ(c.At(0.03F), 0.03F);
  EXPECT_EQ(c.At(0.04F, -1s), 0.04F);
  EXPECT_EQ(c.At(0.05F, 0us), 0.05F);
}

}  // namespace
}  // namespace facewire::retarget
