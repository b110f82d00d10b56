// The program sim_receiver as a host sees it: the driver on its line, and its trace.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <memory>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "core/bus/receiver_bus.h"
#include "hal/system_clock.h"
#include "tests/app/process.h"
#include "tests/app/scratch.h"
#include "tests/hal/far_end.h"

namespace facewire::firmware {
namespace {

using app::Process;
using app::Scratch;
using std::chrono::milliseconds;
using testing::HasSubstr;
using testing::StartsWith;

class SimReceiverProgram : public testing::Test {
 protected:
  std::unique_ptr<Process> Start(std::vector<std::string> options) {
    options.insert(options.begin(), SIM_RECEIVER);
    options.insert(options.end(), {"--link", link_});
    return std::make_unique<Process>(options, scratch_ / "out", scratch_ / "err");
  }
  static void AwaitReady(const Process& program) {
    for (int i = 0; i < 10'000 && program.out().find('\n') == std::string::npos; ++i) {
      std::this_thread::sleep_for(milliseconds(2));
    }
    ASSERT_THAT(program.out(), StartsWith("sim_receiver: 3 servos on "));
  }
  // Ticks the driver on the line until `done`, for half a minute at most.
  bool Drive(int line, const std::function<bool()>& done) {
    const Time end = clock_.Now() + std::chrono::seconds(30);
    while (!done() && clock_.Now() < end) {
      pollfd ready{.fd = line, .events = POLLIN, .revents = 0};
      if (::poll(&ready, 1, 10) > 0) {
        std::array<std::byte, 256> buffer;
        const ssize_t got = ::read(line, buffer.data(), buffer.size());
        if (got > 0) {
          driver_.Receive(std::span(buffer).first(static_cast<std::size_t>(got)), clock_.Now());
        }
      }
      hal::test::SendAll(line, driver_.Tick(clock_.Now(), commands_));
    }
    return done();
  }
  struct Row {
    int servo = -1, torque = 0;
    double goal = 0, commanded = 0, position = 0;
  };
  // Of the samples in the trace.
  std::vector<Row> Rows() const {
    std::istringstream trace(Scratch::Read(scratch_ / "trace.csv"));
    std::vector<Row> rows;
    std::string text;
    while (std::getline(trace, text)) {
      Row row;
      if (std::sscanf(text.c_str(), "%*d,%d,,,%d,%lf,%lf,%lf,", &row.servo, &row.torque, &row.goal,
                      &row.commanded, &row.position) == 5) {
        rows.push_back(row);
      }
    }
    return rows;
  }

  Scratch scratch_;
  std::string link_ = scratch_ / "line";
  hal::SystemClock clock_;
  bus::ReceiverBus driver_;
  std::vector<bus::ServoCommand> commands_{3};
};

TEST_F(SimReceiverProgram, MovesItsServosAsTheDriverSaysAndWritesWhatTheyDo) {
  bus::ReceiverConfig config{
      .hold = milliseconds(100), .ease = milliseconds(100), .release = milliseconds(100)};
  for (std::uint8_t id = 0; id < 3; ++id) {
    (void)config.bus.servos.try_push({.id = id,
                                      .min = 1000,
                                      .max = 2000,
                                      .arrive_speed_per_s = 2000,
                                      .arrive_acceleration_per_s2 = 0,
                                      .top_speed_per_s = 4000});
  }
  config.bus.baud = 115'200;
  ASSERT_TRUE(driver_.Configure(config));
  const auto program =
      Start({"--servos", "3", "--pose", "1300", "--trace", scratch_ / "trace.csv"});
  AwaitReady(*program);
  const hal::posix::UniqueFd line = hal::test::OpenRawTty(link_);
  ASSERT_TRUE(Drive(line.get(), [&] { return driver_.status().state == bus::BusState::kRunning; }));
  commands_[0] = {.position = 1700, .torque = true};
  commands_[1] = {.position = 1250.25F, .torque = true};
  EXPECT_TRUE(Drive(line.get(), [&] {
    return driver_.feedback()[0].position == 1700 && driver_.feedback()[1].position == 1250.25F;
  }));
  EXPECT_FALSE(driver_.feedback()[2].torque);

  // Nobody speaks any more: its own failsafe takes the pulses away. Its clock is the simulated
  // processor's, which may be slow here.
  const auto off = [&] { return Rows().back().torque == 0 && Rows().back().servo != 2; };
  for (int i = 0; i < 3000 && !off(); ++i) std::this_thread::sleep_for(milliseconds(10));
  EXPECT_TRUE(off());
  program->Signal(SIGTERM);
  EXPECT_EQ(program->Wait(), 0);
  EXPECT_FALSE(std::filesystem::is_symlink(link_));
  EXPECT_THAT(program->out(), HasSubstr("\ntorque-on 2\n"));
  EXPECT_THAT(program->out(), HasSubstr("\ntorque-off 2\n"));

  const std::vector<Row> rows = Rows();
  EXPECT_EQ(rows.front().position, 1300) << "where it was at power-on";
  bool there = false;
  for (const Row& row : rows) {
    EXPECT_LT(row.servo, 3);
    if (row.torque == 0) continue;
    EXPECT_NE(row.servo, 2);
    EXPECT_TRUE(row.commanded == 0 || (row.commanded >= 999.5 && row.commanded <= 2000.5));
    there = there || (row.servo == 0 && row.goal == 1700 && std::abs(row.commanded - 1700) < 1 &&
                      std::abs(row.position - 1700) < 20);
  }
  EXPECT_TRUE(there);
}

TEST_F(SimReceiverProgram, RefusesBadOptionsInOneLine) {
  const auto refusal = [&](const std::vector<std::string>& options) {
    const auto program = Start(options);
    EXPECT_EQ(program->Wait(), 2);
    return program->err();
  };
  EXPECT_THAT(refusal({"--servos", "13"}), HasSubstr("--servos"));
  EXPECT_THAT(refusal({"--pose", "3000"}),
              HasSubstr("sim_receiver: --pose: a servo goes from 500"));
  EXPECT_THAT(refusal({"--baud", "9600"}), HasSubstr("--baud"));
  EXPECT_THAT(refusal({"--trace", "/nowhere/at/all.csv"}), HasSubstr("--trace: cannot write"));
  const auto help = Start({"--help"});
  EXPECT_EQ(help->Wait(), 0);
  EXPECT_THAT(help->out(), HasSubstr("--gravity"));
}

}  // namespace
}  // namespace facewire::firmware
