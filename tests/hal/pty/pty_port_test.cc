#include "hal/pty/pty_port.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <array>
#include <cstdlib>
#include <fstream>
#include <stdexcept>

#include "hal/posix/unique_fd.h"
#include "hal/system_clock.h"
#include "tests/hal/far_end.h"
#include "tests/hal/serial_port_conformance.h"

namespace facewire::hal::pty {
namespace {

using test::TemporaryFolder;

// The maker of a pseudo-terminal under a link that stays the same when it is made anew.
class PtyLine {
 public:
  PtyLine() { Plug(); }
  static const char* WhyUnavailable() { return nullptr; }
  SerialPort& port() { return port_; }
  Clock& clock() { return clock_; }
  void FarSend(std::span<const std::byte> bytes) { test::SendAll(master_.get(), bytes); }
  std::vector<std::byte> FarReceive(std::size_t count) {
    return test::ReceiveUpTo(master_.get(), count);
  }
  void Unplug() {
    std::filesystem::remove(link());
    master_.Reset();
  }
  void Plug() {
    master_.Reset(::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC));
    std::array<char, 64> name{};
    if (::unlockpt(master_.get()) != 0 ||
        ::ptsname_r(master_.get(), name.data(), name.size()) != 0) {
      throw std::runtime_error("no pseudo-terminal");
    }
    std::filesystem::create_symlink(name.data(), link());
  }
  void Stall() {}  // the test reads only when it wants to
  void Resume() {}
  std::unique_ptr<SerialPort> SecondPort() { return std::make_unique<PtyPort>(link()); }

 private:
  std::string link() const { return folder_.File("line"); }

  TemporaryFolder folder_;
  posix::UniqueFd master_;
  SystemClock clock_;
  PtyPort port_{link()};
};

}  // namespace
}  // namespace facewire::hal::pty

namespace facewire::hal::test {
INSTANTIATE_TYPED_TEST_SUITE_P(Pty, SerialPortConformance, pty::PtyLine);
INSTANTIATE_TYPED_TEST_SUITE_P(Pty, SerialPortHangUp, pty::PtyLine);
INSTANTIATE_TYPED_TEST_SUITE_P(Pty, SerialPortStall, pty::PtyLine);
INSTANTIATE_TYPED_TEST_SUITE_P(Pty, SerialPortExclusive, pty::PtyLine);
}  // namespace facewire::hal::test

namespace facewire::hal::pty {
namespace {

TEST(PtyPort, SaysWhatIsNotAPseudoTerminal) {
  const TemporaryFolder folder;
  std::ofstream(folder.File("file")) << "text";
  EXPECT_EQ(PtyPort(folder.File("missing")).Open().error(), Errc::kNotFound);
  EXPECT_EQ(PtyPort(folder.File("file")).Open().error(), Errc::kUnsupported);
  EXPECT_EQ(PtyPort("/dev/null").Open().error(), Errc::kUnsupported);
  EXPECT_EQ(PtyPort("/").Open().error(), Errc::kUnsupported);
}

TEST(PtyPort, ReadsWhatWasSentBeforeTheHangUp) {
  PtyLine line;
  ASSERT_TRUE(line.port().Open());
  line.FarSend(test::Bytes(4));
  EXPECT_EQ(test::ReadAll(line.port(), 1), test::Bytes(1));
  line.Unplug();
  std::array<std::byte, 8> buffer{};
  // The kernel may drop what is left at a hang-up; it must not come out wrong or block.
  const Result<std::size_t> rest = line.port().Read(buffer, test::kAmple);
  if (rest) {
    EXPECT_EQ(buffer[0], std::byte{1});
  } else {
    EXPECT_EQ(rest.error(), Errc::kDisconnected);
  }
}

TEST(IsPseudoTerminal, FollowsLinks) {
  const TemporaryFolder folder;
  posix::UniqueFd master(::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC));
  std::array<char, 64> name{};
  ASSERT_EQ(::ptsname_r(master.get(), name.data(), name.size()), 0);
  std::filesystem::create_symlink(name.data(), folder.File("pts"));
  std::filesystem::create_symlink("/dev/null", folder.File("null"));
  EXPECT_EQ(IsPseudoTerminal(folder.File("pts")), true);
  EXPECT_EQ(IsPseudoTerminal(folder.File("null")), false);
  EXPECT_EQ(IsPseudoTerminal(folder.File("missing")).error(), Errc::kNotFound);
}

}  // namespace
}  // namespace facewire::hal::pty
