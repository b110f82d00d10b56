#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <sstream>
#include <thread>

#include "tests/app/process.h"
#include "tests/app/scratch.h"
#include "tests/hal/far_end.h"
#include "tests/sim/bench.h"

// The program sim_bus as others see it: options, a serial device, a trace.

namespace facewire::sim {
namespace {

using app::Process;
using app::Scratch;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

class SimBusProgram : public testing::Test {
 protected:
  std::unique_ptr<Process> Start(std::vector<std::string> options) {
    options.insert(options.begin(), SIM_BUS);
    options.insert(options.end(), {"--link", link_});
    return std::make_unique<Process>(options, scratch_ / "out", scratch_ / "err");
  }
  // Waits for the line that says it is there.
  static void AwaitReady(const Process& program) {
    for (int i = 0; i < 10'000 && program.out().find('\n') == std::string::npos; ++i) {
      std::this_thread::sleep_for(milliseconds(2));
    }
    ASSERT_THAT(program.out(), StartsWith("sim_bus: "));
  }
  Bytes Ask(const Bytes& bytes, std::size_t answer) {
    const hal::posix::UniqueFd line = hal::test::OpenRawTty(link_);
    hal::test::SendAll(line.get(), Raw(bytes));
    return Plain(hal::test::ReceiveUpTo(line.get(), answer));
  }
  // Its error output; it must end with code 2 and leave nothing.
  std::string Refusal(const std::vector<std::string>& options) {
    const auto program = Start(options);
    EXPECT_EQ(program->Wait(), 2);
    EXPECT_EQ(program->out(), "");
    EXPECT_FALSE(std::filesystem::is_symlink(link_));
    const std::string err = program->err();
    EXPECT_EQ(std::count(err.begin(), err.end(), '\n'), 1) << err;
    return err;
  }

  // In the last row of a sample in the trace; 0 while there is none.
  double LastPosition() const {
    std::istringstream trace(Scratch::Read(scratch_ / "trace.csv"));
    std::string row;
    double position = 0;
    while (std::getline(trace, row)) {
      std::sscanf(row.c_str(), "%*d,%*d,,,%*d,%*f,%*f,%lf,", &position);
    }
    return position;
  }

  Scratch scratch_;
  std::string link_ = scratch_ / "line";
};

TEST_F(SimBusProgram, AnswersAsAFeetechChain) {
  const auto program = Start({"sts", "--ids", "1,5"});
  AwaitReady(*program);
  EXPECT_EQ(Ask(Hex("FF FF 01 02 01 FB"), 6), Hex("FF FF 01 02 00 FC"));
  program->Signal(SIGTERM);
  EXPECT_EQ(program->Wait(), 0);
  EXPECT_FALSE(std::filesystem::is_symlink(link_));
}

TEST_F(SimBusProgram, AnswersAsADynamixelChain) {
  const auto program = Start({"xl330", "--servos", "2"});
  AwaitReady(*program);
  const Bytes answer = Ask(Hex("FF FF FD 00 01 03 00 01 19 4E"), 14);
  ASSERT_EQ(answer.size(), 14U);
  EXPECT_EQ(Bytes(answer.begin() + 9, answer.begin() + 11), Hex("B0 04"));
}

TEST_F(SimBusProgram, AnswersAsAMaestro) {
  const auto program = Start({"maestro", "--servos", "12", "--home", "1500"});
  AwaitReady(*program);
  EXPECT_EQ(Ask(Hex("90 0B"), 2), Hex("70 17"));
}

const Bytes kGoal = Hex("FF FF 01 09 03 2A 00 09 00 00 E8 03 D4");

TEST_F(SimBusProgram, HearsTheRightBaudRateWhenItIsStrict) {
  const auto program = Start({"sts", "--strict-baud", "--baud", "115200"});
  AwaitReady(*program);
  EXPECT_EQ(Ask(kGoal, 6), Hex("FF FF 01 02 00 FC"));
}

TEST_F(SimBusProgram, IsDeafToAnotherBaudRateWhenItIsStrict) {
  const auto program = Start({"sts", "--strict-baud", "--seconds", "2"});  // at 1 Mbaud
  AwaitReady(*program);
  const hal::posix::UniqueFd line = hal::test::OpenRawTty(link_);  // at 115200
  hal::test::SendAll(line.get(), Raw(kGoal));
  EXPECT_EQ(program->Wait(), 0);
  EXPECT_THAT(program->out(), Not(HasSubstr("torque-on")));
}

TEST_F(SimBusProgram, WritesATraceOfWhatTheServosDo) {
  const auto program = Start({"sts", "--servos", "1", "--trace", scratch_ / "trace.csv"});
  AwaitReady(*program);
  EXPECT_EQ(Ask(Hex("FF FF 01 09 03 2A 00 09 00 00 E8 03 D4"), 6), Hex("FF FF 01 02 00 FC"));
  const auto arrived = [&] { return std::abs(LastPosition() - 2304) < 8; };
  for (int i = 0; i < 5000 && !arrived(); ++i) std::this_thread::sleep_for(milliseconds(2));
  EXPECT_TRUE(arrived());
  program->Signal(SIGINT);
  EXPECT_EQ(program->Wait(), 0);
  const std::string trace = Scratch::Read(scratch_ / "trace.csv");
  EXPECT_THAT(trace, StartsWith("t_us,servo,event,"));
  EXPECT_THAT(trace, HasSubstr(",0,torque-on,0,"));
  EXPECT_THAT(program->out(), HasSubstr("\ntorque-on 1\n"));
}

TEST_F(SimBusProgram, EndsAfterItsTimeAndCountsWhatHappened) {
  const auto program = Start({"scs", "--seconds", "0.2", "--fault", "brownout:1@0.05"});
  EXPECT_EQ(program->Wait(), 0);
  EXPECT_THAT(program->out(), HasSubstr("brown-out 1\n"));
}

TEST_F(SimBusProgram, HelpsAndEndsWithZero) {
  const auto program = Start({"--help"});
  EXPECT_EQ(program->Wait(), 0);
  EXPECT_THAT(program->out(), HasSubstr("--trace"));
}

TEST_F(SimBusProgram, RefusesBadOptionsInOneLine) {
  EXPECT_THAT(Refusal({}), HasSubstr("KIND"));
  EXPECT_THAT(Refusal({"lx16a"}), HasSubstr("'lx16a' is not maestro, xl330"));
  EXPECT_THAT(Refusal({"maestro", "--servos", "7"}), HasSubstr("6, 12, 18 or 24"));
  EXPECT_THAT(Refusal({"maestro", "--ids", "1"}), HasSubstr("channels"));
  EXPECT_THAT(Refusal({"maestro", "--home", "3000"}), HasSubstr("992 to 2000"));
  EXPECT_THAT(Refusal({"maestro", "--home", "here"}), HasSubstr("off, ignore"));
  EXPECT_THAT(Refusal({"sts", "--ids", "1,1"}), HasSubstr("twice"));
  EXPECT_THAT(Refusal({"sts", "--ids", "300"}), HasSubstr("300"));
  EXPECT_THAT(Refusal({"sts", "--servos", "3", "--ids", "1"}), HasSubstr("not both"));
  EXPECT_THAT(Refusal({"sts", "--servos", "x"}), HasSubstr("--servos"));
  EXPECT_THAT(Refusal({"sts", "--servos", "0"}), HasSubstr("--servos"));
  EXPECT_THAT(Refusal({"sts", "--random-faults", "1000"}), HasSubstr("--random-faults"));
  EXPECT_THAT(Refusal({"sts", "--pose", "high"}), HasSubstr("middle, random"));
  EXPECT_THAT(Refusal({"sts", "--pose", "5000"}), HasSubstr("0 to 4095"));
  EXPECT_THAT(Refusal({"sts", "--fault", "melt:0@1"}), HasSubstr("'melt:0@1'"));
  EXPECT_THAT(Refusal({"sts", "--fault", "mute:4@1"}), HasSubstr("no servo 4"));
  EXPECT_THAT(Refusal({"sts", "--baud", "5"}), HasSubstr("--baud"));
  EXPECT_THAT(Refusal({"maestro", "--strict-baud"}), HasSubstr("does not mind"));
  EXPECT_THAT(Refusal({"sts", "--speed", "5"}), HasSubstr("--speed"));
  EXPECT_THAT(Refusal({"sts", "--trace", "/nowhere/at/all.csv"}), HasSubstr("--trace"));
}

TEST_F(SimBusProgram, LeavesAFileAloneThatIsWhereItsLinkShouldBe) {
  scratch_.Write("line", "mine");
  scratch_.Write("trace.csv", "old");
  EXPECT_THAT(Refusal({"sts", "--trace", scratch_ / "trace.csv"}), HasSubstr("--link"));
  EXPECT_EQ(Scratch::Read(link_), "mine");
  EXPECT_EQ(Scratch::Read(scratch_ / "trace.csv"), "old");
}

}  // namespace
}  // namespace facewire::sim
