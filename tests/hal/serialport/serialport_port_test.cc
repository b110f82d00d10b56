#include "hal/serialport/serialport_port.h"

#include <fcntl.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <fstream>
#include <stdexcept>

#include "hal/posix/unique_fd.h"
#include "hal/system_clock.h"
#include "tests/hal/far_end.h"
#include "tests/hal/serial_port_conformance.h"

namespace facewire::hal::serialport {
namespace {

using test::TemporaryFolder;

constexpr const char* kPairVariable = "FACEWIRE_TEST_TTY";

// Two real serial devices that are wired to each other, named in the environment as
// FACEWIRE_TEST_TTY=/dev/ttyX,/dev/ttyY: on the emulated board ttyACM0 and ttyGS0. The port under
// test is the first.
class TtyLine {
 public:
  TtyLine() {
    const std::string pair = std::getenv(kPairVariable);
    const std::size_t comma = pair.find(',');
    near_ = pair.substr(0, comma);
    far_ = test::OpenRawTty(pair.substr(comma + 1));
    port_ = std::make_unique<SerialportPort>(SerialportConfig{.path = near_, .baud = 115200});
  }
  static const char* WhyUnavailable() {
    const char* pair = std::getenv(kPairVariable);
    return pair != nullptr && std::string(pair).find(',') != std::string::npos
               ? nullptr
               : "needs two serial devices wired to each other: "
                 "FACEWIRE_TEST_TTY=/dev/ttyX,/dev/ttyY";
  }
  SerialPort& port() { return *port_; }
  Clock& clock() { return clock_; }
  void FarSend(std::span<const std::byte> bytes) { test::SendAll(far_.get(), bytes); }
  std::vector<std::byte> FarReceive(std::size_t count) {
    return test::ReceiveUpTo(far_.get(), count);
  }
  std::unique_ptr<SerialPort> SecondPort() {
    return std::make_unique<SerialportPort>(SerialportConfig{.path = near_, .baud = 115200});
  }

 private:
  std::string near_;
  posix::UniqueFd far_;
  SystemClock clock_;
  std::unique_ptr<SerialPort> port_;
};

}  // namespace
}  // namespace facewire::hal::serialport

namespace facewire::hal::test {
INSTANTIATE_TYPED_TEST_SUITE_P(Tty, SerialPortConformance, serialport::TtyLine);
INSTANTIATE_TYPED_TEST_SUITE_P(Tty, SerialPortExclusive, serialport::TtyLine);
// Pulling a device out is a matter of the emulated board's own tests, and a UART takes bytes
// whether or not somebody reads them.
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(SerialPortHangUp);
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(SerialPortStall);
}  // namespace facewire::hal::test

namespace facewire::hal::serialport {
namespace {

Errc OpenError(const std::string& path, int baud = 115200) {
  const Result<> opened = SerialportPort({.path = path, .baud = baud}).Open();
  return opened ? Errc{} : opened.error();
}

// 74880 and 250000 baud (ESP boot loaders, DMX) have no constants of their own in termios.
TEST(SerialportPortOnTtys, BytesPassAtUsualAndUnusualRates) {
  if (const char* why = TtyLine::WhyUnavailable(); why != nullptr) GTEST_SKIP() << why;
  const std::string pair = std::getenv(kPairVariable);
  const std::size_t comma = pair.find(',');
  for (const int baud : {9600, 74880, 115200, 250000, 1000000}) {
    SerialportPort near({.path = pair.substr(0, comma), .baud = baud});
    SerialportPort far({.path = pair.substr(comma + 1), .baud = baud});
    ASSERT_TRUE(near.Open()) << baud;
    ASSERT_TRUE(far.Open()) << baud;
    const auto message = test::Bytes(64);
    ASSERT_EQ(near.Write(message, test::kAmple), 64U) << baud;
    EXPECT_EQ(test::ReadAll(far, 64), message) << baud;
    ASSERT_EQ(far.Write(message, test::kAmple), 64U) << baud;
    EXPECT_EQ(test::ReadAll(near, 64), message) << baud;
  }
}

TEST(SerialportPort, ADeviceThatDoesNotExistIsNotFound) {
  const TemporaryFolder folder;
  std::filesystem::create_symlink("/dev/ttyUSB-of-yesterday", folder.File("link"));
  EXPECT_EQ(OpenError("/dev/ttyFACEWIRE0"), Errc::kNotFound);
  EXPECT_EQ(OpenError(""), Errc::kNotFound);
  EXPECT_EQ(OpenError(folder.File("link")), Errc::kNotFound);
}

TEST(SerialportPort, WhatIsNotASerialLineIsUnsupported) {
  const TemporaryFolder folder;
  std::ofstream(folder.File("file")) << "text";
  EXPECT_EQ(OpenError("/dev/null"), Errc::kUnsupported);
  EXPECT_EQ(OpenError("/dev"), Errc::kUnsupported);
  EXPECT_EQ(OpenError(folder.File("file")), Errc::kUnsupported);
}

TEST(SerialportPort, PseudoTerminalsAreUnsupportedBecauseTheyAreThePtyBackends) {
  const posix::UniqueFd master(::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC));
  std::array<char, 64> name{};
  ASSERT_EQ(::unlockpt(master.get()), 0);
  ASSERT_EQ(::ptsname_r(master.get(), name.data(), name.size()), 0);
  EXPECT_EQ(OpenError(name.data()), Errc::kUnsupported);
}

TEST(SerialportPort, APortThatCouldNotOpenIsDisconnectedAndMayTryAgain) {
  SerialportPort port({.path = "/dev/ttyFACEWIRE0"});
  std::byte byte{};
  EXPECT_EQ(port.Open().error(), Errc::kNotFound);
  EXPECT_EQ(port.Open().error(), Errc::kNotFound);
  EXPECT_EQ(port.Write({&byte, 1}, test::kBrief).error(), Errc::kDisconnected);
  EXPECT_EQ(port.Read({&byte, 1}, test::kBrief).error(), Errc::kDisconnected);
  port.Close();
}

}  // namespace
}  // namespace facewire::hal::serialport
