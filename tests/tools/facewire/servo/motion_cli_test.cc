#include <gmock/gmock.h>
#include <poll.h>
#include <pty.h>

#include "hal/posix/unique_fd.h"
#include "tests/tools/facewire/servo/bench_program.h"

// facewire servo move, jog, limits, set, reboot and wizard, as a builder or a script runs them.

namespace facewire::tools {
namespace {

using app::Replaced;
using testing::HasSubstr;
using testing::Not;

class ServoMotion : public ServoBench {
 protected:
  void StartJaw(const std::string& ids = "1") {
    StartBus("sts", {"sts", "--ids", ids, "--trace", Path("trace.csv")});
    config_ = Write("f.toml", FeetechConfig(scratch_.folder().string()));
    Write("rig.toml", kJawRig);
  }
  // The lowest and the highest position that servo 0 was commanded to while it had torque.
  std::pair<double, double> Commanded() const {
    std::istringstream trace(Read("trace.csv"));
    std::pair<double, double> span{1e9, -1e9};
    std::string row;
    while (std::getline(trace, row)) {
      int torque = 0;
      double goal = 0;
      double commanded = 0;
      if (std::sscanf(row.c_str(), "%*d,0,,,%d,%lf,%lf,", &torque, &goal, &commanded) != 3 ||
          torque == 0) {
        continue;
      }
      span.first = std::min(span.first, commanded);
      span.second = std::max(span.second, commanded);
    }
    return span;
  }

  std::string config_;
};

// facewire on a terminal.
class Terminal {
 public:
  explicit Terminal(const std::vector<std::string>& arguments) {
    int master = -1;
    winsize size{.ws_row = 24, .ws_col = 100, .ws_xpixel = 0, .ws_ypixel = 0};
    pid_ = ::forkpty(&master, nullptr, nullptr, &size);
    if (pid_ == 0) {
      std::vector<char*> words;
      for (const std::string& word : arguments) words.push_back(const_cast<char*>(word.c_str()));
      words.push_back(nullptr);
      ::execv(words[0], words.data());
      ::_exit(127);
    }
    master_.Reset(master);
  }
  ~Terminal() {
    if (pid_ > 0) ::kill(pid_, SIGKILL), ::waitpid(pid_, nullptr, 0);
  }
  void Type(const std::string& keys) const {
    ASSERT_EQ(::write(master_.get(), keys.data(), keys.size()), static_cast<ssize_t>(keys.size()));
  }
  // Whether the newest screen comes to show it.
  bool Shows(const std::string& text) {
    for (int i = 0; i < 2000; ++i) {
      Read();
      const std::size_t home = seen_.rfind("\x1b[H");
      const std::size_t before = home == std::string::npos || home == 0
                                     ? std::string::npos
                                     : seen_.rfind("\x1b[H", home - 1);
      if (before != std::string::npos &&
          seen_.substr(before, home - before).find(text) != std::string::npos) {
        return true;
      }
    }
    ADD_FAILURE() << "not shown: " << text << "\n" << seen_.substr(seen_.rfind("\x1b[H"));
    return false;
  }
  int Wait() {
    int status = 0;
    while (::waitpid(pid_, &status, WNOHANG) == 0) Read();
    pid_ = 0;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

 private:
  void Read() {
    pollfd ready{.fd = master_.get(), .events = POLLIN, .revents = 0};
    char buffer[4096];
    if (::poll(&ready, 1, 10) <= 0) return;
    const ssize_t count = ::read(master_.get(), buffer, sizeof buffer);
    if (count > 0) seen_.append(buffer, static_cast<std::size_t>(count));
  }

  hal::posix::UniqueFd master_;
  pid_t pid_ = 0;
  std::string seen_;
};

TEST_F(ServoMotion, MovesWithinTheLimitsAndLetsGo) {
  StartJaw();
  Outcome outcome = Servo({"move", "jaw", "2100", "--seconds", "0.3", "--config", config_});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, testing::ContainsRegex("jaw: told 2100, is at 2(09[5-9]|10[0-5])"));
  outcome = Servo({"move", "jaw", "2301", "--config", config_});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(outcome.err, "facewire: 2301 is outside the limits of \"jaw\", 1900 to 2300\n");
  const std::string counted = EndBus();
  EXPECT_THAT(counted, HasSubstr("torque-on 1\n"));
  EXPECT_THAT(counted, HasSubstr("torque-off 1\n"));
}

TEST_F(ServoMotion, JogsByKeysOnAScreenAndIsLimpAtTheEnd) {
  StartJaw();
  {
    Terminal terminal({FACEWIRE_TOOL, "servo", "jog", "jaw", "--config", config_});
    ASSERT_TRUE(terminal.Shows("told   limp"));
    terminal.Type("n");
    ASSERT_TRUE(terminal.Shows("told   2000 counts"));
    terminal.Type("\x1b[C\x1b[A");  // right, up: 2 and 20 of 400 counts
    ASSERT_TRUE(terminal.Shows("told   2022 counts"));
    terminal.Type(" ");
    ASSERT_TRUE(terminal.Shows("told   limp"));
    // The port is busy meanwhile.
    const Outcome other = Servo({"list", "--config", config_});
    EXPECT_EQ(other.code, 2);
    EXPECT_THAT(other.err, HasSubstr("sudo systemctl stop facewired"));
    terminal.Type("\x1b[B");  // down, from where it is
    ASSERT_TRUE(terminal.Shows("told   200"));
    terminal.Type("q");
    EXPECT_EQ(terminal.Wait(), 0);
  }
  EXPECT_THAT(EndBus(), HasSubstr("torque-off 2\n"));
  EXPECT_GE(Commanded().first, 1900 - 60);  // it may have stood a little outside: 2048 it did not
  EXPECT_LE(Commanded().second, 2300);
}

TEST_F(ServoMotion, TakesLimitsByExampleAndKeepsTheFile) {
  StartJaw();
  Outcome outcome =
      Servo({"limits", "jaw", "--config", config_}, "=1800 1\n=2400 2 n 3 right enter\ny\n");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  std::string expected = Replaced(kJawRig, "[[0, 1900], [1, 2300]]", "[[0, 1800], [1, 2400]]");
  EXPECT_EQ(Read("rig.toml"), expected);
  outcome = Servo({"limits", "jaw", "--config", config_, "--map", "keep"},
                  "=2350 2 =1850 1 =1950 3 enter");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("min 1800 -> 1850, max 2400 -> 2350, neutral 2000 -> 1950"));
  expected = Replaced(expected, "# down is open\n", "# down is open\nmin = 1850\nmax = 2350\n");
  EXPECT_EQ(Read("rig.toml"), Replaced(expected, "neutral = 2000", "neutral = 1950"));
}

TEST_F(ServoMotion, LimitsThatAreGivenUpChangeNothing) {
  StartJaw();
  Outcome outcome = Servo({"limits", "jaw", "--config", config_}, "=2200 1 enter quit");
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(outcome.err, HasSubstr("given up"));
  outcome = Servo({"limits", "jaw", "--config", config_}, "=2200 rihgt");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("\"rihgt\" is no key; left, right"));
  EXPECT_EQ(Read("rig.toml"), kJawRig);
}

TEST_F(ServoMotion, WritesSettingsByCommandAndReadsThemBack) {
  StartJaw("1,3");
  Outcome outcome = Servo({"set", "jaw", "min-position", "1900", "--config", config_, "--yes"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(Servo({"list", "--config", config_}).out, Not(HasSubstr("min position limit")));
  outcome = Servo({"set", "face/3", "id", "1", "--config", config_, "--yes"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("id 1 is another servo's already"));
  EXPECT_EQ(Servo({"set", "face/3", "id", "9", "--config", config_, "--yes"}).code, 0);
  EXPECT_EQ(Servo({"reboot", "face/9", "--config", config_, "--yes"}).code, 0);
  outcome = Servo({"set", "jaw", "mode", "1", "--config", config_}, "n\n");
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(outcome.err, HasSubstr("nothing was written"));
  EXPECT_EQ(Servo({"set", "jaw", "moo", "1", "--config", config_, "--yes"}).code, 2);
}

TEST_F(ServoMotion, BringsAServoToAnotherRateWhereItAnswersFromThenOn) {
  StartBus("sts", {"sts", "--ids", "1", "--strict-baud"});
  config_ = Write("f.toml", FeetechConfig(scratch_.folder().string()));
  Write("rig.toml", kJawRig);
  Outcome outcome = Servo({"set", "jaw", "baud", "115200", "--config", config_, "--yes"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(outcome.out,
            "jaw: baud is 115200 now, as read back\n"
            "write it into the configuration, too: baud = 115200 in the [[bus]] \"face\", whose "
            "servos must all have it\n");
  // The configuration has the old rate still.
  outcome = Servo({"set", "jaw", "lock", "closed", "--config", config_, "--yes"});
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(outcome.err, HasSubstr("at 1000000 baud does not answer; facewire servo find lists"));
  outcome =
      Servo({"set", "jaw", "baud", "1000000", "--baud", "115200", "--config", config_, "--yes"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(Servo({"set", "jaw", "lock", "closed", "--config", config_, "--yes"}).code, 0);
}

TEST_F(ServoMotion, ADynamixelChangesItsRateTheSameWay) {
  StartBus("xl", {"xl330", "--ids", "1", "--baud", "57600", "--strict-baud"});
  config_ =
      Write("f.toml",
            "[character]\nrig = \"rig.toml\"\nprofile = \"\"\n[[bus]]\nname = \"face\"\nkind = "
            "\"dynamixel\"\nbaud = 57600\nport = \"serial:" +
                Path("xl") + "\"\n");
  Write("rig.toml", kJawRig);
  Outcome outcome = Servo({"set", "jaw", "baud", "1000000", "--config", config_, "--yes"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("jaw: baud is 1000000 now, as read back\n"));
  EXPECT_EQ(Servo({"set", "jaw", "return-delay", "250", "--config", config_, "--yes"}).code, 1)
      << "it hears at its new rate only";
  outcome =
      Servo({"set", "jaw", "baud", "57600", "--baud", "1000000", "--config", config_, "--yes"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(Servo({"set", "jaw", "return-delay", "250", "--config", config_, "--yes"}).code, 0);
}

TEST_F(ServoMotion, ARateThatAServoDoesNotHaveIsRefusedWithThoseThatItHas) {
  StartJaw();
  const Outcome outcome = Servo({"set", "jaw", "baud", "9600", "--config", config_, "--yes"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("\"9600\" is no rate of this servo; expected one of 1000000"));
}

TEST_F(ServoMotion, TheWizardAddsBareServosToAConfigurationThatTheServiceAccepts) {
  StartBus("sts", {"sts", "--ids", "1,2"});
  const std::string config =
      Write("f.toml", std::string("[tracker]\nnetworks = \"") + FACEWIRE_ASSETS +
                          "/networks\"\n[character]\nrig = \"rig.toml\"\nprofile = \"\"");
  Write("rig.toml",
        "name = \"a\"  # mine\n[[parameter]]\nname = \"tilt\"\ndrive = { \"head.pitch\" = 0.1 }\n");
  const Outcome outcome =
      Servo({"wizard", Path("sts"), "--kind", "feetech", "--config", config},
            "y\nface\nw\ntild\ntilt\n\n=2150 1 =1950 2 =2000 3 enter\nhand\ntail\n"
            "=1900 1 =2150 2 =2000 3 enter\n");
  EXPECT_EQ(outcome.code, 0) << outcome.err << outcome.out;
  EXPECT_THAT(outcome.out, HasSubstr("There is no channel \"tild\"; did you mean \"tilt\"?"));
  EXPECT_THAT(Read("rig.toml"), HasSubstr("name = \"a\"  # mine\n"));
  // It falls: the servo is mounted the other way round.
  EXPECT_THAT(Read("rig.toml"), HasSubstr("map = [[0, 2150], [1, 1950]]"));
  app::Process check({FACEWIRED, "--config", config, "--check"}, Path("out"), Path("err"));
  EXPECT_EQ(check.Wait(), 0) << check.err();
  EXPECT_EQ(Servo({"move", "tilt", "2100", "--config", config}).code, 0);
}

TEST_F(ServoMotion, AWizardWhoseAnswersEndWritesNothing) {
  StartBus("sts", {"sts", "--ids", "1"});
  const Outcome outcome =
      Servo({"wizard", Path("sts"), "--kind", "feetech", "--out", Path("new")}, "y\nface\n");
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(outcome.err, HasSubstr("the answers ended; nothing was written"));
  EXPECT_FALSE(std::filesystem::exists(Path("new")));
  EXPECT_EQ(Servo({"wizard"}).code, 2);
}

}  // namespace
}  // namespace facewire::tools
