// The program with a replayed face and three simulated buses on pseudo-terminals: the jaw moves on
// all of them, and whoever asks it to end finds every servo limp.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "tests/app/facewired.h"
#include "tests/app/process.h"
#include "tests/app/scratch.h"

namespace facewire::app {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::HasSubstr;

std::string Servo(const std::string& bus, int id, int neutral, int open) {
  return "[[servo]]\nname = \"jaw-" + bus + "\"\nbus = \"" + bus +
         "\"\nid = " + std::to_string(id) + "\nfrom = { \"jaw.pitch\" = 1 }\nmap = [[0, " +
         std::to_string(neutral) + "], [24, " + std::to_string(open) +
         "]]\nmax_speed = 4000\nmax_acceleration = 40000\ncrawl_speed = 2000\n";
}

std::string Bus(const std::string& name, const std::string& kind) {
  return "[[bus]]\nname = \"" + name + "\"\nkind = \"" + kind + "\"\nport = \"serial:" + name +
         "\"\n";
}

class Buses : public testing::Test {
 protected:
  Buses() {
    std::string rig = Scratch::Read(kRig);
    rig += Servo("maestro", 0, 1500, 1900) + Servo("sts", 1, 2048, 2700) +
           Servo("xl330", 1, 2048, 2700);
    scratch_.Write("rig.toml", rig);
    std::string config =
        Configuration("[control]\nsocket = \"control\"\n" + Bus("maestro", "maestro") +
                          Bus("sts", "feetech") + Bus("xl330", "dynamixel"),
                      "rig.toml");
    config = Replaced(config, "line = \"pty:line\"", "line = \"none\"");
    scratch_.Write("facewire.toml", config);
    Start("maestro", {});
    Start("sts", {"--servos", "1"});
    Start("xl330", {"--servos", "1", "--baud", "57600"});
  }
  void Start(const std::string& kind, std::vector<std::string> options) {
    options.insert(options.begin(),
                   {SIM_BUS, kind, "--link", File(kind), "--trace", File(kind + ".csv")});
    sims_.push_back(std::make_unique<Process>(options, File(kind + ".out"), File(kind + ".err")));
    EXPECT_TRUE(Soon([&] { return std::filesystem::is_symlink(File(kind)); }));
  }
  template <class Condition>
  static bool Soon(Condition condition) {
    for (const auto end = std::chrono::steady_clock::now() + seconds(90); !condition();) {
      if (std::chrono::steady_clock::now() > end) return false;
      std::this_thread::sleep_for(milliseconds(50));
    }
    return true;
  }

  std::string File(const std::string& name) const { return (scratch_ / name.c_str()).string(); }

  struct Trace {
    double least = 1e9;
    double most = -1e9;
    bool torque = false;  // in the end
    bool ever = false;
  };
  // Of servo 0, from when it first had torque.
  Trace Read(const std::string& kind) const {
    std::istringstream rows(Scratch::Read(File(kind + ".csv")));
    Trace trace;
    for (std::string row; std::getline(rows, row);) {
      int servo = 0;
      int torque = 0;
      double position = 0;
      if (std::sscanf(row.c_str(), "%*d,%d,,,%d,%*f,%*f,%lf,", &servo, &torque, &position) != 3 ||
          servo != 0) {
        continue;
      }
      trace.torque = torque != 0;
      trace.ever = trace.ever || trace.torque;
      if (!trace.ever) continue;
      trace.least = std::min(trace.least, position);
      trace.most = std::max(trace.most, position);
    }
    return trace;
  }

  Scratch scratch_;
  std::vector<std::unique_ptr<Process>> sims_;
};

TEST_F(Buses, MoveTheJawOfAReplayedFaceAndAreLeftLimp) {
  Process service({FACEWIRED, "--config", (scratch_ / "facewire.toml").string()}, scratch_ / "out",
                  scratch_ / "err");
  for (const char* kind : {"maestro", "sts", "xl330"}) {
    EXPECT_TRUE(Soon([&] {
      const Trace trace = Read(kind);
      return trace.torque && trace.most - trace.least > 40;
    })) << kind
        << ": " << service.err();
  }
  Process status({FACEWIRE_TOOL, "status", (scratch_ / "control").string()}, scratch_ / "status",
                 scratch_ / "status.err");
  EXPECT_EQ(status.Wait(), 0) << status.err();
  EXPECT_THAT(status.out(), HasSubstr("bus      sts: feetech, "));
  EXPECT_THAT(status.out(), HasSubstr("servo    jaw-xl330 (xl330 1)      on, following"));
  // The face never opens its mouth as far.
  Process hand({FACEWIRE_TOOL, "servo", "move", "jaw-sts", "2690", "--live", "--seconds", "2",
                "--config", (scratch_ / "facewire.toml").string()},
               scratch_ / "hand", scratch_ / "hand.err");
  EXPECT_EQ(hand.Wait(), 0) << hand.err();
  EXPECT_EQ(hand.out(), "jaw-sts: was held at 2690 counts; the performer has it again\n");
  service.Signal(SIGTERM);
  EXPECT_EQ(service.Wait(), 0) << service.err();
  EXPECT_EQ(service.err().find("servo "), std::string::npos) << service.err();
  for (const auto& sim : sims_) {
    sim->Signal(SIGTERM);
    EXPECT_EQ(sim->Wait(), 0);
  }
  for (const char* kind : {"maestro", "sts", "xl330"}) EXPECT_FALSE(Read(kind).torque) << kind;
  EXPECT_NEAR(Read("sts").most, 2690, 20);
  EXPECT_LT(Read("xl330").most, 2600);
}

TEST_F(Buses, AreNamedByACheckOfTheConfiguration) {
  Process check({FACEWIRED, "--config", (scratch_ / "facewire.toml").string(), "--check"},
                scratch_ / "out", scratch_ / "err");
  EXPECT_EQ(check.Wait(), 0) << check.err();
  EXPECT_THAT(check.out(), HasSubstr("servos   3\n"));
  EXPECT_THAT(check.out(), HasSubstr(", 50 Hz: jaw-maestro (0)\n"));
  EXPECT_THAT(check.out(), HasSubstr(", 100 Hz: jaw-sts (1)\n"));
}

TEST_F(Buses, RefuseAServoWhoseBusIsMissing) {
  scratch_.Write("facewire.toml",
                 Scratch::Read(scratch_ / "facewire.toml") + Bus("other", "maestro"));
  scratch_.Write("rig.toml", Scratch::Read(scratch_ / "rig.toml") + Servo("nowhere", 0, 1, 2));
  Process check({FACEWIRED, "--config", (scratch_ / "facewire.toml").string(), "--check"},
                scratch_ / "out", scratch_ / "err");
  EXPECT_EQ(check.Wait(), 2);
  EXPECT_THAT(check.err(), HasSubstr("servo \"jaw-nowhere\": there is no bus \"nowhere\""));
  EXPECT_THAT(check.err(), HasSubstr("bus \"other\": no servo of the rig is on it"));
}

}  // namespace
}  // namespace facewire::app
