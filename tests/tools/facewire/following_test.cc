#include "tools/facewire/following.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <functional>

#include "tests/app/scratch.h"

namespace facewire::tools {
namespace {

using app::BadInputOf;
using app::Scratch;
using testing::HasSubstr;

constexpr double kEndS = 12;

servo::Servo Jaw() {
  servo::Servo servo;
  servo.name = *ShortName::From("jaw");
  servo.min = 1000;
  servo.max = 2000;
  servo.dead_band = 5;
  return servo;
}

double Swing(double t_s) { return 1500 + 300 * std::sin(2 * t_s) + 50 * std::sin(9 * t_s); }
double Rest(double) { return 1500; }

using Motion = std::function<double(double)>;

// Poses at 30 a second.
Curve Poses(const Motion& motion) {
  Curve curve;
  for (int i = 0; i <= kEndS * 30; ++i) curve.push_back({i / 30.0, motion(i / 30.0)});
  return curve;
}

// A servo that is told every millisecond, so much later, and is there so much later again. It has
// torque from 1 s to `off_s`.
std::vector<ServoRow> Rows(const Motion& motion, double command_s, double position_s,
                           double off_s = kEndS + 0.5) {
  std::vector<ServoRow> rows;
  for (int i = 0; i < 13'000; ++i) {
    const double t_s = i / 1000.0;
    const double goal = motion(t_s - command_s);
    rows.push_back(
        {t_s, t_s >= 1 && t_s < off_s, goal, goal, motion(t_s - command_s - position_s)});
  }
  return rows;
}

TEST(Following, FindsHowFarEachIsBehind) {
  const auto f = Measure(Jaw(), Poses(Swing), Rows(Swing, 0.070, 0.040));
  EXPECT_NEAR(f.command.lag_ms, 70, 2);
  EXPECT_NEAR(f.position.lag_ms, 40, 2);
  EXPECT_LT(f.command.rms, 3);  // what a line between two poses misses of a curve
  EXPECT_LT(f.position.largest, 3);
  EXPECT_NEAR(f.moved, 700, 40);
  EXPECT_FALSE(f.torque_at_end);
  EXPECT_EQ(WhyNot(Jaw(), f, 0.25), "");
}

TEST(Following, SaysHowMuchIsLeftWhenTheDelayIsTakenOut) {
  auto rows = Rows(Swing, 0.050, 0.030);
  for (ServoRow& row : rows) row.position += 12;
  const auto f = Measure(Jaw(), Poses(Swing), rows);
  EXPECT_NEAR(f.position.rms, 12, 0.5);
  EXPECT_NEAR(f.position.largest, 12, 2);
}

TEST(Following, HasNoLagWhereNothingMoves) {
  const auto f = Measure(Jaw(), Poses(Rest), Rows(Rest, 0.05, 0.05));
  EXPECT_TRUE(std::isnan(f.command.lag_ms));
  EXPECT_TRUE(std::isnan(f.position.lag_ms));
  EXPECT_EQ(f.command.rms, 0);
  EXPECT_EQ(WhyNot(Jaw(), f, 0.25), "");
}

TEST(Following, BeginsWhenTheCrawlIsOver) {
  auto rows = Rows(Swing, 0.05, 0.03);
  // From far away, until 4 s.
  for (ServoRow& row : rows) {
    if (row.t_s < 4) row.goal = row.commanded = row.position = 1000;
  }
  const auto f = Measure(Jaw(), Poses(Swing), rows);
  EXPECT_NEAR(f.span.from_s, 4 + kSettledS, 0.01);
  EXPECT_NEAR(f.span.to_s, kEndS, 0.01);
  EXPECT_NEAR(f.command.lag_ms, 50, 2);
}

TEST(Following, BeginsWhenTheServosOwnCrawlIsOverToo) {
  auto rows = Rows(Swing, 0.05, 0.03);
  for (ServoRow& row : rows) {
    if (row.t_s < 5) row.commanded = row.position = 1000;  // its goal was at the parameter at once
  }
  const auto f = Measure(Jaw(), Poses(Swing), rows);
  EXPECT_NEAR(f.span.from_s, 5 + kSettledS, 0.01);
  EXPECT_EQ(f.unresolved, 0);
}

TEST(Following, EndsWithTheTorque) {
  const auto f = Measure(Jaw(), Poses(Swing), Rows(Swing, 0.05, 0.03, 8));
  EXPECT_NEAR(f.span.to_s, 8, 0.01);
}

TEST(Following, ShowsTheLiveliestPartLarge) {
  const Motion nod = [](double t_s) {
    return t_s > 7 && t_s < 8.5 ? 1500 + 200 * std::sin(20 * (t_s - 7)) : 1500.0;
  };
  const auto f = Measure(Jaw(), Poses(nod), Rows(nod, 0.05, 0.03));
  EXPECT_NEAR(f.liveliest.to_s - f.liveliest.from_s, kCloseUpS, 0.01);
  EXPECT_LE(f.liveliest.from_s, 7.1);
  EXPECT_GE(f.liveliest.to_s, 8.4);
}

TEST(Following, FindsWhatABusCannotResolve) {
  auto rows = Rows(Rest, 0, 0);
  for (ServoRow& row : rows) row.commanded += 0.4;
  const auto f = Measure(Jaw(), Poses(Rest), rows);
  EXPECT_NEAR(f.unresolved, 0.4, 1e-9);
  EXPECT_EQ(WhyNot(Jaw(), f, 0.5), "");
  EXPECT_THAT(WhyNot(Jaw(), f, 0.25), HasSubstr("comes to rest 0.40 from its command"));
}

TEST(Following, NamesWhatWentWrong) {
  const auto why = [](const std::vector<ServoRow>& rows) {
    return WhyNot(Jaw(), Measure(Jaw(), Poses(Swing), rows), 0.25);
  };
  EXPECT_THAT(why(Rows(Swing, 0.05, 0.03, 1000)), HasSubstr("torque at the end"));
  EXPECT_THAT(why(Rows(Swing, 0.35, 0.03)), HasSubstr("commands too late"));
  EXPECT_THAT(why(Rows(Swing, 0.05, 0.35)), HasSubstr("moves too late"));

  auto beyond = Rows(Swing, 0.05, 0.03);
  beyond[5000].goal = 2001;
  EXPECT_THAT(why(beyond), HasSubstr("1.0 beyond its limits"));
  auto stuck = Rows(Swing, 0.05, 0.03);
  for (ServoRow& row : stuck) row.position = 1500;
  EXPECT_THAT(why(stuck), HasSubstr("does not go where it is told"));
  auto deaf = Rows(Swing, 0.05, 0.03);
  for (ServoRow& row : deaf) row.goal = row.commanded = row.position = 1500;
  EXPECT_THAT(why(deaf), HasSubstr("other commands than its parameter asks for"));
}

TEST(Following, RefusesAServoThatWasHardlyAtWork) {
  EXPECT_THAT(BadInputOf([] { Measure(Jaw(), Poses(Swing), Rows(Swing, 0.05, 0.03, 1)); }),
              HasSubstr("\"jaw\" was never told to be where its parameter was"));
  EXPECT_THAT(BadInputOf([] { Measure(Jaw(), Poses(Swing), Rows(Swing, 0.05, 0.03, 2)); }),
              HasSubstr("\"jaw\" was never at work for long enough"));
}

constexpr char kHeader[] =
    "t_us,servo,event,detail,torque_on,goal,commanded,position,speed,current_A,temperature_C,"
    "torque_Nm,voltage_V\n";

TEST(ServoTrace, HasTheRowsOfOneServo) {
  const Scratch scratch;
  const auto rows =
      ReadServoRows(scratch.Write("t.csv", std::string(kHeader) +
                                               "1000000,0,,,1,1500.25,1500.00,1499.50,0,0,25,0,5\n"
                                               "1000500,1,torque-on,0,,,,,,,,,\n"
                                               "2000000,1,,,0,2,3,4,0,0,25,0,5\n"),
                    0);
  ASSERT_EQ(rows.size(), 1U);
  EXPECT_EQ(rows[0].t_s, 1);
  EXPECT_TRUE(rows[0].torque_on);
  EXPECT_EQ(rows[0].goal, 1500.25);
  EXPECT_EQ(rows[0].commanded, 1500);
  EXPECT_EQ(rows[0].position, 1499.5);
}

TEST(ServoTrace, SaysWhatIsWrongAndWhere) {
  const Scratch scratch;
  const auto refusal = [&](const std::string& content) {
    const auto path = scratch.Write("t.csv", content);
    return BadInputOf([&] { ReadServoRows(path, 0); });
  };
  EXPECT_THAT(refusal("frame,t_us\n"), HasSubstr("t.csv:1: no trace of a simulated bus"));
  EXPECT_THAT(refusal(kHeader), HasSubstr("it has no servo 0"));
  EXPECT_THAT(refusal(std::string(kHeader) + "1,0,,\n"), HasSubstr("t.csv:2: a row has 8 fields"));
  EXPECT_THAT(refusal(std::string(kHeader) + "1,0,,,1,x,0,0,0\n"),
              HasSubstr("t.csv:2: \"x\" is not a number"));
  EXPECT_THAT(BadInputOf([] { ReadServoRows("/nowhere/at/all.csv", 0); }),
              HasSubstr("cannot read the trace"));
}

}  // namespace
}  // namespace facewire::tools
