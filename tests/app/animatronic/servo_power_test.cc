#include "app/animatronic/servo_power.h"

#include <gtest/gtest.h>

namespace facewire::app {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

// One bus with one servo, and a contract of 4 s.
struct Bench {
  Bench() {
    report.bus_count = report.servo_count = 1;
    report.buses[0].port = PortState::kUp;
  }
  bool After(Duration time) {
    now += time;
    report.at = now;
    return power.Allowed(report, now);
  }

  servo::Contract contract{.fresh = milliseconds(500),
                           .hold = milliseconds(500),
                           .ease = seconds(1),
                           .limp = seconds(2)};
  ServoPower power{contract};
  ServoReport report;
  Time now{seconds(100)};
};

TEST(ServoPower, IsOnWhileAllIsWell) {
  Bench b;
  EXPECT_TRUE(b.After(seconds(0)));
  EXPECT_TRUE(b.After(seconds(3600)));
}

TEST(ServoPower, IsOffBeforeTheFirstReportAndWhenReportsEnd) {
  Bench b;
  EXPECT_FALSE(b.power.Allowed({}, b.now));
  EXPECT_TRUE(b.After(seconds(1)));
  EXPECT_TRUE(b.power.Allowed(b.report, b.now + seconds(1)));
  EXPECT_FALSE(b.power.Allowed(b.report, b.now + milliseconds(1001)));
}

TEST(ServoPower, GoesOffWhenAPortIsLostForLongerThanTheContract) {
  Bench b;
  b.report.buses[0].closed = b.now;
  EXPECT_TRUE(b.After(seconds(4)));
  EXPECT_FALSE(b.After(milliseconds(1)));
  EXPECT_FALSE(b.After(seconds(100)));
  b.report.buses[0].closed.reset();
  EXPECT_TRUE(b.After(milliseconds(1)));
}

TEST(ServoPower, IsCutOnceForAServoThatNobodyCanTellToLetGo) {
  Bench b;
  b.report.servos[0].stranded = b.now;
  EXPECT_TRUE(b.After(seconds(4)));
  EXPECT_FALSE(b.After(milliseconds(1)));
  EXPECT_FALSE(b.After(milliseconds(1999)));
  EXPECT_TRUE(b.After(milliseconds(1)));
  EXPECT_TRUE(b.After(seconds(100))) << "still gone, but it was without power";
  b.report.servos[0].stranded.reset();
  EXPECT_TRUE(b.After(seconds(1)));
  b.report.servos[0].stranded = b.now;
  EXPECT_FALSE(b.After(seconds(5))) << "once more";
}

TEST(ServoPower, IsNotCutAgainForThoseWhoFellSilentWithThePower) {
  Bench b;
  b.report.servo_count = 2;
  b.report.servos[0].stranded = b.now;
  EXPECT_FALSE(b.After(milliseconds(4001)));
  b.report.servos[1].stranded = b.now + milliseconds(300);
  EXPECT_TRUE(b.After(seconds(2)));
  EXPECT_TRUE(b.After(seconds(100)));
}

}  // namespace
}  // namespace facewire::app
