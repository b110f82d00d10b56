#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

#include "tests/tools/facewire/run.h"

namespace facewire::tools {
namespace {

using testing::ContainsRegex;
using testing::HasSubstr;

constexpr char kConfig[] =
    "[character]\nrig = \"rig.toml\"\nprofile = \"\"\n"
    "[[bus]]\nname = \"head\"\nkind = \"maestro\"\nport = \"serial:head\"\n";
constexpr char kRig[] =
    "name = \"mini\"\n[[parameter]]\nname = \"jawOpen\"\n"
    "[[servo]]\nname = \"jaw\"\nbus = \"head\"\nid = 0\nfrom = { jawOpen = 1 }\n"
    "map = [[0, 1000], [1, 2000]]\nmax_speed = 4000\n"
    "[[servo]]\nname = \"tail\"\nbus = \"head\"\nid = 1\nmin = 1000\nmax = 2000\nmax_speed = 1\n";
constexpr double kBootS = 4711;  // since the machine's

double Swing(double t_s) { return 0.5 + 0.3 * std::sin(3 * t_s); }

// Ten seconds of a jaw, as the monitor records it, and of a servo 60 ms behind, as a simulated bus
// does.
class FacewireServoSheet : public testing::Test {
 protected:
  FacewireServoSheet() {
    scratch_.Write("facewire.toml", kConfig);
    scratch_.Write("rig.toml", kRig);
    std::string poses = "frame,t_us,age_us,state,jawOpen\n";
    for (int i = 0; i < 300; ++i) {
      const double t_s = i / 30.0;
      poses += std::to_string(i) + "," + Micros(t_s - 0.02) + ",20000,tracking," +
               std::to_string(Swing(t_s)) + "\n";
    }
    scratch_.Write("wire.csv", poses);
    scratch_.Write("head.csv", Trace(kBootS));
  }
  static std::string Micros(double t_s) {
    return std::to_string(std::llround((kBootS + t_s) * 1e6));
  }
  // `boot_s`: of the machine that it ran on.
  static std::string Trace(double boot_s, bool limp_at_end = true) {
    std::string trace = "t_us,servo,event,detail,torque_on,goal,commanded,position,speed,a,b,c,d\n";
    for (int i = 0; i <= 5250; ++i) {
      const double t_s = i / 500.0;
      const std::string goal = std::to_string(1000 + 1000 * Swing(t_s - 0.06));
      trace += std::to_string(std::llround((boot_s + t_s) * 1e6)) + ",0,,," +
               (i == 5250 && limp_at_end ? "0,0,0" : "1," + goal + "," + goal) + "," +
               std::to_string(1000 + 1000 * Swing(t_s - 0.1)) + ",0,0,25,0,5\n";
    }
    return trace;
  }
  Outcome Draw(const std::vector<std::string>& servos, std::vector<std::string> more = {}) {
    std::vector<std::string> all{"sheet",    scratch_.Path("wire.csv"),
                                 "--config", scratch_.Path("facewire.toml"),
                                 "--out",    scratch_.Path("s.png")};
    for (const std::string& servo : servos) all.insert(all.end(), {"--servo", servo});
    all.insert(all.end(), more.begin(), more.end());
    return RunFacewire(all);
  }
  std::string Jaw() const { return "jaw=" + scratch_.Path("head.csv") + ":0"; }
  // Of a bad input, which must leave no picture.
  std::string Refusal(const std::vector<std::string>& servos) {
    const Outcome outcome = Draw(servos);
    EXPECT_EQ(outcome.code, 2);
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_EQ(scratch_.Files(), 4U);
    return outcome.err;
  }

  Scratch scratch_;
};

TEST_F(FacewireServoSheet, DrawsWhatAServoDidAndSaysHowFarBehindItWas) {
  const Outcome outcome = Draw({Jaw()}, {"--check"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  // To the measure's 2 ms.
  EXPECT_THAT(outcome.out, ContainsRegex("jaw +maestro +(60|62) ms .* (38|40) ms"));
  const cv::Mat one = cv::imread(scratch_.Path("s.png"));
  EXPECT_EQ(one.cols, 1600);
  ASSERT_EQ(Draw({Jaw(), Jaw()}).code, 0);
  EXPECT_GT(cv::imread(scratch_.Path("s.png")).rows, one.rows + 150);
}

TEST_F(FacewireServoSheet, DrawsAndFailsWhenAServoHasTorqueAtTheEnd) {
  scratch_.Write("head.csv", Trace(kBootS, false));
  EXPECT_EQ(Draw({Jaw()}).code, 0);
  const Outcome outcome = Draw({Jaw()}, {"--check"});
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(outcome.err, HasSubstr("jaw has torque at the end"));
  EXPECT_FALSE(cv::imread(scratch_.Path("s.png")).empty());
}

TEST_F(FacewireServoSheet, RefusesWhatItCannotDraw) {
  for (const char* servo : {"jaw", "jaw=head.csv", "jaw=head.csv:", "jaw=head.csv:x",
                            "jaw=head.csv:-1", "head.csv:0"}) {
    EXPECT_THAT(Refusal({servo}), HasSubstr("NAME=TRACE:INDEX would be right")) << servo;
  }
  const std::string trace = scratch_.Path("head.csv");
  EXPECT_THAT(Refusal({"chin=" + trace + ":0"}), HasSubstr("has no servo \"chin\""));
  EXPECT_THAT(Refusal({"tail=" + trace + ":0"}), HasSubstr("no channel moves it"));
  EXPECT_THAT(Refusal({"jaw=" + trace + ":7"}), HasSubstr("it has no servo 7"));
  EXPECT_THAT(Refusal({"jaw=" + scratch_.Path("wire.csv") + ":0"}),
              HasSubstr("wire.csv:1: no trace"));
  EXPECT_THAT(Refusal({"jaw=" + scratch_.Path("none.csv") + ":0"}), HasSubstr("cannot read"));
}

TEST_F(FacewireServoSheet, RefusesATraceOfAnotherRun) {
  scratch_.Write("head.csv", Trace(kBootS + 3600));
  EXPECT_THAT(Refusal({Jaw()}), HasSubstr("no time in common"));
}

TEST_F(FacewireServoSheet, NeedsARecordingAndTheConfiguration) {
  const Outcome outcome = RunFacewire(
      {"sheet", scratch_.Path("wire.csv"), "--servo", Jaw(), "--out", scratch_.Path("s.png")});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("--servo needs a RECORDING and the service's --config"));
}

}  // namespace
}  // namespace facewire::tools
