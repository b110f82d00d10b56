#include "hal/local/local_socket.h"

#include <gtest/gtest.h>
#include <poll.h>
#include <sys/stat.h>

#include <fstream>
#include <stdexcept>

#include "hal/local/local_listener.h"
#include "hal/local/local_port.h"
#include "hal/system_clock.h"
#include "tests/hal/far_end.h"
#include "tests/hal/serial_port_conformance.h"

namespace facewire::hal::local {
namespace {

using test::TemporaryFolder;

// A server that takes the port as its one client when there is something to say.
class LocalLine {
 public:
  LocalLine() { Plug(); }
  static const char* WhyUnavailable() { return nullptr; }
  SerialPort& port() { return port_; }
  Clock& clock() { return clock_; }
  void FarSend(std::span<const std::byte> bytes) { test::SendAll(FarEnd(), bytes); }
  std::vector<std::byte> FarReceive(std::size_t count) {
    return test::ReceiveUpTo(FarEnd(), count);
  }
  void Unplug() {
    (void)TakeNewcomer();
    listener_.Close();
    client_.Reset();
  }
  void Plug() {
    if (!listener_.Open(path())) throw std::runtime_error("cannot listen at " + path());
  }
  void Stall() {}  // the test reads only when it wants to
  void Resume() {}

 private:
  std::string path() const { return folder_.File("socket"); }
  bool TakeNewcomer() {
    Result<posix::UniqueFd> newcomer = listener_.Accept();
    if (newcomer) client_ = std::move(*newcomer);
    return newcomer.has_value();
  }
  // Of the port as it was opened last.
  int FarEnd() {
    while (TakeNewcomer()) {
    }
    if (!client_) throw std::runtime_error("the port has not connected");
    return client_.get();
  }

  TemporaryFolder folder_;
  LocalListener listener_;
  posix::UniqueFd client_;
  SystemClock clock_;
  LocalPort port_{path()};
};

}  // namespace
}  // namespace facewire::hal::local

namespace facewire::hal::test {
INSTANTIATE_TYPED_TEST_SUITE_P(Local, SerialPortConformance, local::LocalLine);
INSTANTIATE_TYPED_TEST_SUITE_P(Local, SerialPortHangUp, local::LocalLine);
INSTANTIATE_TYPED_TEST_SUITE_P(Local, SerialPortStall, local::LocalLine);
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(SerialPortExclusive);  // many clients may come
}  // namespace facewire::hal::test

namespace facewire::hal::local {
namespace {

mode_t ModeOf(const std::string& path) {
  struct stat node {};
  return ::stat(path.c_str(), &node) == 0 ? node.st_mode & 0777U : 0;
}

TEST(LocalPort, SaysWhereNobodyIs) {
  const TemporaryFolder folder;
  std::ofstream(folder.File("file")) << "text";
  EXPECT_EQ(LocalPort(folder.File("missing")).Open().error(), Errc::kNotFound);
  EXPECT_EQ(LocalPort(folder.File("file")).Open().error(), Errc::kUnsupported);
  EXPECT_EQ(LocalPort(std::string(200, 'x')).Open().error(), Errc::kInvalidArgument);
}

TEST(LocalListener, LetsItsGroupInAndNobodyElseWhateverTheMask) {
  const TemporaryFolder folder;
  for (const mode_t mask : {0U, 0027U, 0077U}) {
    const mode_t before = ::umask(mask);
    LocalListener listener;
    const Result<> opened = listener.Open(folder.File("socket"));
    ::umask(before);
    ASSERT_TRUE(opened);
    EXPECT_EQ(ModeOf(folder.File("socket")), 0660U);
  }
}

TEST(LocalListener, RemovesItsFileAtTheEnd) {
  const TemporaryFolder folder;
  {
    LocalListener listener;
    ASSERT_TRUE(listener.Open(folder.File("socket")));
    EXPECT_TRUE(*IsSocket(folder.File("socket")));
  }
  EXPECT_EQ(IsSocket(folder.File("socket")).error(), Errc::kNotFound);
}

TEST(LocalListener, ReplacesAFileThatAKilledProgramLeft) {
  const TemporaryFolder folder;
  {
    const Result<posix::UniqueFd> killed = MakeSocket();
    ASSERT_TRUE(killed);
    ASSERT_TRUE(Bind(killed->get(), folder.File("socket")));
  }
  EXPECT_EQ(LocalPort(folder.File("socket")).Open().error(), Errc::kNotFound);
  LocalListener listener;
  ASSERT_TRUE(listener.Open(folder.File("socket")));
  EXPECT_TRUE(LocalPort(folder.File("socket")).Open());
}

TEST(LocalListener, LeavesSomebodyElsesPlaceAlone) {
  const TemporaryFolder folder;
  LocalListener first;
  ASSERT_TRUE(first.Open(folder.File("socket")));
  LocalListener second;
  EXPECT_EQ(second.Open(folder.File("socket")).error(), Errc::kBusy);
  second.Close();
  EXPECT_TRUE(LocalPort(folder.File("socket")).Open()) << "the first one still serves";

  std::ofstream(folder.File("file")) << "text";
  EXPECT_EQ(second.Open(folder.File("file")).error(), Errc::kUnsupported);
  EXPECT_TRUE(std::filesystem::exists(folder.File("file")));
  EXPECT_EQ(second.Open(folder.File("no/folder")).error(), Errc::kNotFound);
  EXPECT_EQ(second.Open(std::string(200, 'x')).error(), Errc::kInvalidArgument);
}

TEST(LocalListener, DoesNotRemoveAFileThatTookThePlaceOfItsOwn) {
  const TemporaryFolder folder;
  LocalListener first;
  ASSERT_TRUE(first.Open(folder.File("socket")));
  std::filesystem::remove(folder.File("socket"));
  LocalListener second;
  ASSERT_TRUE(second.Open(folder.File("socket")));
  first.Close();
  EXPECT_TRUE(LocalPort(folder.File("socket")).Open());
}

TEST(LocalListener, HasNobodyUntilSomebodyConnects) {
  const TemporaryFolder folder;
  LocalListener listener;
  EXPECT_EQ(listener.Accept().error(), Errc::kDisconnected);
  ASSERT_TRUE(listener.Open(folder.File("socket")));
  EXPECT_EQ(listener.Accept().error(), Errc::kNotReady);
  LocalPort port(folder.File("socket"));
  ASSERT_TRUE(port.Open());
  EXPECT_TRUE(listener.Accept());
  EXPECT_EQ(listener.Accept().error(), Errc::kNotReady);
}

}  // namespace
}  // namespace facewire::hal::local
