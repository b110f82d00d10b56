// SerialportPort when its cable is pulled, on both ends of a USB serial line that the kernel
// provides. What needs no pulling is tried on the same line by tests/hal/serialport.

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "hal/posix/unique_fd.h"
#include "hal/serialport/serialport_port.h"
#include "hal/system_clock.h"
#include "tests/devices/gadget.h"
#include "tests/hal/far_end.h"
#include "tests/hal/serial_port_conformance.h"

namespace facewire::devices {
namespace {

using hal::SerialPort;
using hal::serialport::SerialportPort;
using hal::test::Bytes;
using hal::test::kAmple;
using hal::test::kBrief;
using hal::test::OpenRawTty;
using hal::test::ReadAll;
using std::chrono::milliseconds;

// A computer's end, whose node goes with the cable. The far end is the gadget.
class ComputerLine {
 public:
  ComputerLine() {
    PlugCable();
    far_ = OpenRawTty(kGadgetTty);
  }
  static const char* WhyUnavailable() { return nullptr; }
  SerialPort& port() { return port_; }
  hal::Clock& clock() { return clock_; }
  void FarSend(std::span<const std::byte> bytes) { hal::test::SendAll(far_.get(), bytes); }
  std::vector<std::byte> FarReceive(std::size_t count) {
    return hal::test::ReceiveUpTo(far_.get(), count);
  }
  static void Unplug() { PullCable(); }
  void Plug() {
    PlugCable();
    far_ = OpenRawTty(kGadgetTty);  // the gadget's end was hung up as well
  }
  // Nobody reads there: the kernel's buffers fill up, and then the cable's.
  static void Stall() {}
  static void Resume() {}

 private:
  hal::SystemClock clock_;
  hal::posix::UniqueFd far_;
  SerialportPort port_{{.path = kHostTty}};
};

}  // namespace
}  // namespace facewire::devices

namespace facewire::hal::test {
INSTANTIATE_TYPED_TEST_SUITE_P(Gadget, SerialPortHangUp, devices::ComputerLine);
INSTANTIATE_TYPED_TEST_SUITE_P(Gadget, SerialPortStall, devices::ComputerLine);
// hal_serialport_test runs these on the same line.
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(SerialPortConformance);
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(SerialPortExclusive);
}  // namespace facewire::hal::test

namespace facewire::devices {
namespace {

// A board's end: the node stays when the computer is unplugged.
class BoardPortTest : public ::testing::Test {
 protected:
  void SetUp() override {
    PlugCable();
    computer = OpenRawTty(kHostTty);
    ASSERT_TRUE(port.Open());
  }
  void TearDown() override {
    port.Close();
    computer.Reset();
    PlugCable();
  }

  SerialportPort port{{.path = kGadgetTty}};
  hal::posix::UniqueFd computer;
};

TEST_F(BoardPortTest, IsDisconnectedWhenTheComputerGoes) {
  PullCable();
  std::byte byte{};
  EXPECT_EQ(port.Read({&byte, 1}, kAmple).error(), Errc::kDisconnected);
  EXPECT_EQ(port.Write({&byte, 1}, kAmple).error(), Errc::kDisconnected);
}

TEST_F(BoardPortTest, OpensWithoutTheComputerAndTakesWhatItsBufferHolds) {
  PullCable();
  std::byte byte{};
  EXPECT_EQ(port.Write({&byte, 1}, kAmple).error(), Errc::kDisconnected);
  // The gadget's driver opens without a cable, and takes what its buffer holds.
  ASSERT_TRUE(port.Open());
  const auto much = Bytes(std::size_t{1} << 16U);
  const Result<std::size_t> part = port.Write(much, kBrief);
  ASSERT_TRUE(part);
  EXPECT_LT(*part, much.size());
  EXPECT_EQ(port.Write(much, kBrief).error(), Errc::kTimeout);
  EXPECT_EQ(port.Read({&byte, 1}, kBrief).error(), Errc::kTimeout);
}

TEST_F(BoardPortTest, SpeaksAgainWhenTheComputerIsBack) {
  PullCable();
  std::byte byte{};
  EXPECT_EQ(port.Write({&byte, 1}, kAmple).error(), Errc::kDisconnected);
  computer.Reset();  // held on to, it would keep its number, and the line come back as ttyACM1
  PlugCable();
  computer = OpenRawTty(kHostTty);
  ASSERT_TRUE(port.Open());
  const auto message = Bytes(16);
  ASSERT_EQ(port.Write(message, kAmple), 16U);
  EXPECT_EQ(hal::test::ReceiveUpTo(computer.get(), 16), message);
  hal::test::SendAll(computer.get(), message);
  EXPECT_EQ(ReadAll(port, 16), message);
}

// The gadget's driver drops nothing on request and waits for 15 s (GS_CLOSE_TIMEOUT) for a computer
// that is there but does not read. Whoever supervises a program on such a line must wait longer.
TEST_F(BoardPortTest, ClosesInTheEndThoughNobodyReads) {
  computer.Reset();
  const auto much = Bytes(std::size_t{1} << 16U);
  static_cast<void>(port.Write(much, kBrief));  // cut short
  hal::SystemClock clock;
  const Time before = clock.Now();
  port.Close();
  EXPECT_LT(clock.Now() - before, milliseconds(20000));
}

}  // namespace
}  // namespace facewire::devices
