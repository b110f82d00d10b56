#include "core/servo/follower.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/core/servo/generated_servos.h"

namespace facewire::servo {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr Duration kFrame = milliseconds(30);

class FollowerTest : public testing::Test {
 protected:
  void Configure() {
    follower_.Configure(servo_, following_, 0.25);
    now_ = seconds(1);
  }
  void Take(double wish) {
    now_ += kFrame;
    follower_.Take(wish, now_, kFrame);
  }
  double Goal(Duration later = Duration::zero()) const { return follower_.GoalAt(now_ + later); }

  Servo servo_ = PulseServo("jaw", 0);
  Following following_{.calm = 0};
  Follower follower_;
  Duration now_{};
};

TEST_F(FollowerTest, TheFirstWishIsTheGoal) {
  Configure();
  Take(1700);
  EXPECT_EQ(Goal(), 1700);
  EXPECT_EQ(Goal(seconds(10)), 1700);
}

TEST_F(FollowerTest, GoesStraightToTheNextWishInOneFrame) {
  Configure();
  Take(1700);
  Take(1760);
  EXPECT_EQ(Goal(), 1700);
  EXPECT_NEAR(Goal(milliseconds(10)), 1720, 1e-9);
  EXPECT_EQ(Goal(kFrame), 1760);
  EXPECT_EQ(Goal(seconds(1)), 1760) << "and stays there";
}

TEST_F(FollowerTest, AWishThatComesEarlyGoesOnFromWhereTheGoalIs) {
  Configure();
  Take(1700);
  Take(1760);
  now_ += milliseconds(15);
  follower_.Take(1800, now_, kFrame);
  EXPECT_NEAR(Goal(), 1730, 1e-9);
  EXPECT_EQ(Goal(kFrame), 1800);
}

TEST_F(FollowerTest, WithALeadASteadyMotionHasNoLag) {
  following_.lead = kFrame;
  Configure();
  for (int frame = 0; frame < 20; ++frame) Take(1000 + 12 * frame);
  // The last wish came now, at 1228: the goal is there, and not a frame behind.
  EXPECT_NEAR(Goal(), 1228, 1e-6);
  EXPECT_NEAR(Goal(kFrame), 1240, 1e-6);
}

TEST_F(FollowerTest, ALeadIsTakenBackWhenTheMotionEnds) {
  following_.lead = kFrame;
  Configure();
  for (int frame = 0; frame < 20; ++frame) Take(1000 + 12 * frame);
  EXPECT_NEAR(Goal(3 * kFrame), 1228, 1e-6) << "nothing came after the last";
}

TEST_F(FollowerTest, StaysWithinTheDeadBandAndThenGoesAllTheWay) {
  Configure();
  Take(1500);
  Take(1504);
  EXPECT_EQ(Goal(kFrame), 1500);
  Take(1496);
  EXPECT_EQ(Goal(kFrame), 1500);
  Take(1504.1);
  EXPECT_EQ(Goal(3 * kFrame), 1504.1);
}

TEST_F(FollowerTest, ATurnMustGoThroughTheBacklash) {
  servo_.backlash = 20;
  Configure();
  Take(1500);
  Take(1521);
  Take(1526);
  EXPECT_EQ(Goal(kFrame), 1526) << "onward the dead band counts";
  Take(1507);
  EXPECT_EQ(Goal(kFrame), 1526) << "the gear would not have turned its output";
  Take(1505);
  EXPECT_EQ(Goal(3 * kFrame), 1505);
}

TEST_F(FollowerTest, ASlowMotionDoesNotStopBetweenItsSteps) {
  Configure();
  for (int frame = 0; frame < 30; ++frame)
    Take(1500 + 2.5 * frame);  // every second leaves the band
  double before = Goal();
  for (int frame = 30; frame < 60; ++frame) {
    Take(1500 + 2.5 * frame);
    for (int ms = 0; ms < 30; ms += 10) {
      EXPECT_GT(Goal(milliseconds(ms)) - before + (ms == 0 ? 1 : 0), 0.5) << frame;
      before = Goal(milliseconds(ms));
    }
  }
}

TEST_F(FollowerTest, TremblingIsAveragedAndMotionPasses) {
  following_.calm = 3;
  Configure();
  Take(1500);
  for (int frame = 0; frame < 1000; ++frame) Take(frame % 2 == 0 ? 1504 : 1496);
  EXPECT_EQ(Goal(kFrame), 1500);
  Take(1900);
  EXPECT_NEAR(Goal(kFrame), 1900, 1);
}

TEST_F(FollowerTest, NothingStaysOffByMoreThanTheDeadBand) {
  following_.calm = 10;
  Configure();
  for (const double wish : {1510, 1504, 1300, 1305, 1299}) {
    for (int frame = 0; frame < 300; ++frame) Take(wish);
    EXPECT_NEAR(Goal(kFrame), wish, 4 + 1e-3);
  }
}

TEST_F(FollowerTest, AfterAResetTheNextWishIsTakenAsItIs) {
  following_.calm = 3;
  Configure();
  Take(1500);
  follower_.Reset();
  Take(1503);
  EXPECT_EQ(Goal(), 1503);
}

}  // namespace
}  // namespace facewire::servo
