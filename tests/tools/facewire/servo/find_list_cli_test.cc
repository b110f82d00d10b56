#include <gmock/gmock.h>

#include "tests/tools/facewire/servo/bench_program.h"

// facewire servo find and list, as a builder runs them.

namespace facewire::tools {
namespace {

using testing::HasSubstr;
using testing::Not;

class ServoFind : public ServoBench {};
class ServoList : public ServoBench {};

TEST_F(ServoFind, AChainAtARateOfItsOwnIsFoundAndShownReadyToPaste) {
  StartBus("line", {"xl330", "--ids", "3,9", "--baud", "115200", "--strict-baud"});
  const Outcome outcome = Servo({"find", Path("line"), "--kind", "dynamixel"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("Dynamixel at 115200 baud\n    id   model"));
  EXPECT_THAT(outcome.out, HasSubstr("    9    XL330-M288"));
  EXPECT_THAT(outcome.out, HasSubstr("kind = \"dynamixel\"\nport = \"serial:" + Path("line") +
                                     "\"\nbaud = 115200\n"));
  EXPECT_THAT(EndBus(), Not(HasSubstr("torque-on")));
}

TEST_F(ServoFind, ALineThatTakesAnyRateIsOneBus) {
  StartBus("line", {"sts"});
  const Outcome outcome = Servo({"find", "--quiet", Path("line"), "--kind", "feetech"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  EXPECT_THAT(outcome.out, HasSubstr("at 1000000 baud"));
  EXPECT_THAT(outcome.out, Not(HasSubstr("at 500000 baud")));
}

TEST_F(ServoFind, SaysWhatWasTriedWhereNobodyAnswers) {
  StartBus("line", {"sts", "--ids", "77"});
  const Outcome outcome =
      Servo({"find", "--quiet", Path("line"), "--kind", "feetech", "--baud", "1000000"});
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(outcome.out, HasSubstr("no servos; tried were\n  Feetech at 1000000 baud\n"));
  EXPECT_THAT(outcome.err, HasSubstr("--all asks every id"));
  EXPECT_EQ(
      Servo({"find", "--quiet", Path("line"), "--kind", "feetech", "--baud", "1000000", "--all"})
          .code,
      0);
}

TEST_F(ServoFind, APortThatIsNotThereIsOneLine) {
  const Outcome outcome = Servo({"find", Path("nothing")});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(outcome.err, "facewire: there is no port " + Path("nothing") +
                             "; `facewire doctor` lists those there are\n");
}

TEST_F(ServoList, ShowsEveryServoAndTheCommandThatMendsItsSettings) {
  StartBus("sts", {"sts", "--ids", "1"});
  const std::string config = Write("f.toml", FeetechConfig(scratch_.folder().string()));
  Write("rig.toml", std::string(kJawRig) +
                        "[[servo]]\nname = \"brow\"\nbus = \"face\"\nid = 2\n"
                        "min = 0\nmax = 4095\nmax_speed = 100\n");
  Outcome outcome = Servo({"list", "--config", config});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, testing::ContainsRegex(
                               "jaw +face +1 +limp +204[789] +1900..2300 +25 C +0 % +7.4 V +none"));
  EXPECT_THAT(outcome.out, HasSubstr("jaw: min position limit is 0, should be 1900: facewire servo "
                                     "set jaw min-position 1900 --config " +
                                     config));
  EXPECT_THAT(outcome.out, HasSubstr("brow: does not answer, though others of its bus do"));

  outcome = Servo({"list", "--json", "--config", config});
  EXPECT_EQ(outcome.code, 0);
  EXPECT_THAT(outcome.out,
              HasSubstr("{\"servo\":\"jaw\",\"bus\":\"face\",\"id\":1,\"state\":\"limp\""));
  EXPECT_THAT(outcome.out, HasSubstr("\"temperature_c\":null"));
  EXPECT_THAT(EndBus(), Not(HasSubstr("torque-on")));
}

TEST_F(ServoList, SaysThatNobodyAnswersAndWhatToLookAt) {
  StartBus("sts", {"sts", "--ids", "9"});
  const std::string config = Write("f.toml", FeetechConfig(scratch_.folder().string()));
  Write("rig.toml", kJawRig);
  const Outcome outcome = Servo({"list", "--config", config});
  EXPECT_EQ(outcome.code, 0);
  EXPECT_THAT(outcome.out, HasSubstr("nobody answers; are the servos powered"));
}

TEST_F(ServoList, AConfigurationWithoutBusesSaysHowToGetThem) {
  const std::string config = Write("f.toml", "[character]\nrig = \"rig.toml\"\nprofile = \"\"\n");
  Write("rig.toml", kJawRig);
  const Outcome outcome = Servo({"list", "--config", config});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("has no [[bus]]; `facewire servo find` prints one"));
}

}  // namespace
}  // namespace facewire::tools
