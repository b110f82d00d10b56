#include "hal/pty/pty_host.h"

#include <fcntl.h>
#include <gtest/gtest.h>

#include <fstream>

#include "hal/posix/unique_fd.h"
#include "hal/pty/pty_port.h"
#include "hal/system_clock.h"
#include "tests/hal/far_end.h"
#include "tests/hal/serial_port_conformance.h"

namespace facewire::hal::pty {
namespace {

using std::chrono::milliseconds;
using test::Bytes;
using test::kAmple;
using test::kBrief;
using test::TemporaryFolder;

posix::UniqueFd OpenDevice(const std::string& path) {
  return posix::UniqueFd(::open(path.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC));
}

// A host whose device another program opens as soon as it is there, without any settings of its
// own.
class HostWithGuest final : public SerialPort {
 public:
  Result<> Open() override {
    const bool fresh = host.device_path().empty();
    if (Result<> open = host.Open(); !open) return open;
    if (fresh) guest = OpenDevice(host.device_path());
    return {};
  }
  Result<std::size_t> Write(std::span<const std::byte> bytes, milliseconds timeout) override {
    return host.Write(bytes, timeout);
  }
  Result<std::size_t> Read(std::span<std::byte> buffer, milliseconds timeout) override {
    return host.Read(buffer, timeout);
  }
  void Close() override { host.Close(); }

  PtyHost host;
  posix::UniqueFd guest;
};

class HostLine {
 public:
  static const char* WhyUnavailable() { return nullptr; }
  SerialPort& port() { return port_; }
  Clock& clock() { return clock_; }
  void FarSend(std::span<const std::byte> bytes) { test::SendAll(port_.guest.get(), bytes); }
  std::vector<std::byte> FarReceive(std::size_t count) {
    return test::ReceiveUpTo(port_.guest.get(), count);
  }
  void Stall() {}  // the guest reads only when the test wants it to
  void Resume() {}

 private:
  HostWithGuest port_;
  SystemClock clock_;
};

}  // namespace
}  // namespace facewire::hal::pty

namespace facewire::hal::test {
INSTANTIATE_TYPED_TEST_SUITE_P(PtyHost, SerialPortConformance, pty::HostLine);
INSTANTIATE_TYPED_TEST_SUITE_P(PtyHost, SerialPortStall, pty::HostLine);
}  // namespace facewire::hal::test

namespace facewire::hal::pty {
namespace {

TEST(PtyHost, NobodyAtTheOtherEndIsSilence) {
  PtyHost host;
  ASSERT_TRUE(host.Open());
  std::byte byte{};
  SystemClock clock;
  const Time before = clock.Now();
  EXPECT_EQ(host.Write(Bytes(4), kBrief).error(), Errc::kTimeout);
  EXPECT_EQ(host.Read({&byte, 1}, kBrief).error(), Errc::kTimeout);
  EXPECT_GE(clock.Now() - before, 2 * kBrief);
  EXPECT_EQ(host.Write(Bytes(4), milliseconds(0)).error(), Errc::kTimeout);
}

TEST(PtyHost, ReadersComeAndGo) {
  PtyHost host;
  ASSERT_TRUE(host.Open());
  for (unsigned round = 0; round < 3; ++round) {
    const posix::UniqueFd guest = OpenDevice(host.device_path());
    ASSERT_TRUE(guest);
    const auto message = Bytes(32, round);
    ASSERT_EQ(host.Write(message, kAmple), 32U);
    EXPECT_EQ(test::ReceiveUpTo(guest.get(), 32), message);
    test::SendAll(guest.get(), message);
    EXPECT_EQ(test::ReadAll(host, 32), message);
  }
  std::byte byte{};
  EXPECT_EQ(host.Read({&byte, 1}, kBrief).error(), Errc::kTimeout);
}

TEST(PtyHost, AReaderStartsWithFreshBytes) {
  PtyHost host;
  ASSERT_TRUE(host.Open());
  {
    const posix::UniqueFd guest = OpenDevice(host.device_path());
    ASSERT_EQ(host.Write(Bytes(32, 'a'), kAmple), 32U);
  }
  EXPECT_EQ(host.Write(Bytes(1), milliseconds(0)).error(), Errc::kTimeout);
  const posix::UniqueFd guest = OpenDevice(host.device_path());
  ASSERT_EQ(host.Write(Bytes(8, 'A'), kAmple), 8U);
  EXPECT_EQ(test::ReceiveUpTo(guest.get(), 8), Bytes(8, 'A'));
}

TEST(PtyHost, TakesNoMoreOfAMessageWhoseReaderLeaves) {
  PtyHost host;
  ASSERT_TRUE(host.Open());
  posix::UniqueFd guest = OpenDevice(host.device_path());
  const auto much = Bytes(test::kMoreThanAnyBuffer);
  const Result<std::size_t> part = host.Write(much, kBrief);
  ASSERT_TRUE(part);
  guest.Reset();
  EXPECT_EQ(host.Write(std::span(much).subspan(*part), kBrief).error(), Errc::kTimeout);
  guest = OpenDevice(host.device_path());
  ASSERT_EQ(host.Write(Bytes(8), kAmple), 8U);
  EXPECT_EQ(test::ReceiveUpTo(guest.get(), 8), Bytes(8));
}

TEST(PtyHost, ItsDeviceIsALineForAPtyPort) {
  PtyHost host;
  ASSERT_TRUE(host.Open());
  PtyPort port(host.device_path());
  ASSERT_TRUE(port.Open());
  ASSERT_EQ(host.Write(Bytes(256), kAmple), 256U);
  EXPECT_EQ(test::ReadAll(port, 256), Bytes(256));
  std::byte byte{};
  host.Close();
  EXPECT_EQ(port.Read({&byte, 1}, kAmple).error(), Errc::kDisconnected);
}

TEST(PtyHost, MakesItsLinkAndRemovesIt) {
  const TemporaryFolder folder;
  const std::string link = folder.File("line");
  PtyHost host(link);
  ASSERT_TRUE(host.Open());
  EXPECT_EQ(std::filesystem::read_symlink(link), host.device_path());
  host.Close();
  EXPECT_FALSE(std::filesystem::is_symlink(link));
  EXPECT_TRUE(host.device_path().empty());
}

TEST(PtyHost, ReplacesAnOldLinkButNothingElse) {
  const TemporaryFolder folder;
  const std::string link = folder.File("line");
  std::filesystem::create_symlink("/dev/pts/of-an-earlier-run", link);
  PtyHost host(link);
  ASSERT_TRUE(host.Open());
  EXPECT_EQ(std::filesystem::read_symlink(link), host.device_path());

  const std::string file = folder.File("file");
  std::ofstream(file) << "precious";
  EXPECT_EQ(PtyHost(file).Open().error(), Errc::kBusy);
  EXPECT_TRUE(std::filesystem::is_regular_file(file));
  EXPECT_EQ(PtyHost(folder.File("missing/line")).Open().error(), Errc::kNotFound);
}

TEST(PtyHost, LeavesALinkThatAnotherHostHasTakenOver) {
  const TemporaryFolder folder;
  const std::string link = folder.File("line");
  PtyHost first(link);
  PtyHost second(link);
  ASSERT_TRUE(first.Open());
  ASSERT_TRUE(second.Open());
  first.Close();
  EXPECT_EQ(std::filesystem::read_symlink(link), second.device_path());
}

}  // namespace
}  // namespace facewire::hal::pty
