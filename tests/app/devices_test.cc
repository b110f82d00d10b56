#include "app/devices.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <fstream>

#include "app/error.h"
#include "hal/fake/fake_camera.h"
#include "hal/fake/fake_clock.h"
#include "hal/posix/unique_fd.h"
#include "tests/hal/far_end.h"

namespace facewire::app {
namespace {

using hal::posix::UniqueFd;
using hal::test::TemporaryFolder;
using std::chrono::milliseconds;
using testing::HasSubstr;
using testing::Not;
using testing::ThrowsMessage;

auto SaysOneLine(const std::string& text) {
  return ThrowsMessage<BadInput>(testing::AllOf(HasSubstr(text), Not(HasSubstr("\n"))));
}

struct Terminal {
  Terminal() : master(::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC)) {
    std::array<char, 64> text{};
    ::unlockpt(master.get());
    ::ptsname_r(master.get(), text.data(), text.size());
    name = text.data();
  }
  UniqueFd master;
  std::string name;
};

TEST(MakeSerialPort, TakesAPseudoTerminalAndALinkToOne) {
  const TemporaryFolder folder;
  const Terminal terminal;
  std::filesystem::create_symlink(terminal.name, folder.File("link"));
  for (const std::string& path : {terminal.name, folder.File("link")}) {
    const auto port = MakeSerialPort(path, 115200);
    OpenSerialPort(*port, path, 115200);
    const std::byte byte{0x55};
    EXPECT_EQ(port->Write({&byte, 1}, milliseconds(1000)), 1U);
    EXPECT_EQ(hal::test::ReceiveUpTo(terminal.master.get(), 1), std::vector{byte});
  }
}

TEST(MakeSerialPort, FindsADeviceThatComesLaterAndComesBackAsAnother) {
  const TemporaryFolder folder;
  const std::string link = folder.File("link");
  const auto port = MakeSerialPort(link, 115200);
  EXPECT_EQ(port->Open().error(), Errc::kNotFound);
  std::byte byte{};
  for (int round = 0; round < 2; ++round) {
    const Terminal terminal;
    std::filesystem::remove(link);
    std::filesystem::create_symlink(terminal.name, link);
    ASSERT_TRUE(port->Open());
    EXPECT_EQ(port->Write({&byte, 1}, milliseconds(1000)), 1U);
    port->Close();
    EXPECT_EQ(port->Write({&byte, 1}, milliseconds(1000)).error(), Errc::kDisconnected);
  }
}

TEST(OpenSerialPort, SaysInOneLineWhatIsWrong) {
  const TemporaryFolder folder;
  std::ofstream(folder.File("file")) << "text";
  const auto opening = [](const std::string& path) {
    return [path] { OpenSerialPort(*MakeSerialPort(path, 9600), path, 9600); };
  };
  EXPECT_THAT(opening("/dev/ttyFACEWIRE0"), SaysOneLine("there is no port /dev/ttyFACEWIRE0"));
  EXPECT_THAT(opening(folder.File("file")), SaysOneLine("is not a serial line that can do 9600"));
  EXPECT_THAT(opening("/dev/null"), SaysOneLine("/dev/null is not a serial line"));

  const Terminal terminal;
  const auto first = MakeSerialPort(terminal.name, 9600);
  ASSERT_TRUE(first->Open());
  EXPECT_THAT(opening(terminal.name), SaysOneLine("in use by another program"));
}

TEST(MakeHostLine, KnowsItsAddresses) {
  const TemporaryFolder folder;
  const std::string link = folder.File("host");
  const auto host = MakeHostLine("pty:" + link, 115200);
  OpenSerialPort(*host, "pty:" + link, 115200);
  const auto guest = MakeHostLine("serial:" + link, 115200);
  OpenSerialPort(*guest, "serial:" + link, 115200);
  const std::byte sent{0x42};
  std::byte got{};
  ASSERT_EQ(host->Write({&sent, 1}, milliseconds(1000)), 1U);
  ASSERT_EQ(guest->Read({&got, 1}, milliseconds(1000)), 1U);
  EXPECT_EQ(got, sent);
  EXPECT_THAT([] { MakeHostLine("/dev/ttyACM0", 115200); }, SaysOneLine("give serial:PATH"));
}

TEST(MakeHostLine, SaysWhyALinkCannotBeMade) {
  const TemporaryFolder folder;
  std::ofstream(folder.File("file")) << "text";
  const auto opening = [](const std::string& address) {
    return [address] { OpenSerialPort(*MakeHostLine(address, 9600), address, 9600); };
  };
  EXPECT_THAT(opening("pty:" + folder.File("file")), SaysOneLine("is not a link"));
  EXPECT_THAT(opening("pty:" + folder.File("missing/link")), SaysOneLine("does not exist"));
}

TEST(StartCamera, SaysInOneLineWhatIsWrong) {
  const TemporaryFolder folder;
  std::ofstream(folder.File("text.mp4")) << "not a video";
  hal::fake::FakeClock clock;
  const auto starting = [&clock](const std::string& address, CameraOptions options = {}) {
    return
        [&clock, address, options] { StartCamera(*MakeCamera(address, options, clock), address); };
  };
  EXPECT_THAT(starting("v4l2:/dev/video-of-nobody"),
              SaysOneLine("/dev/video-of-nobody: there is no such device"));
  EXPECT_THAT(starting("v4l2:/dev/null"), SaysOneLine("/dev/null: not a video device"));
  EXPECT_THAT(starting("replay:/missing.mp4"), SaysOneLine("there is no video /missing.mp4"));
  EXPECT_THAT(starting("/missing.mp4"), SaysOneLine("there is no video /missing.mp4"));
  EXPECT_THAT(starting(folder.File("text.mp4")), SaysOneLine("is not a video that can be played"));
  EXPECT_THAT(starting("libcamera:of-nobody"), SaysOneLine("libcamera:of-nobody: "));
  const std::string clip = FACEWIRE_ASSETS "/footage/franck.mp4";
  EXPECT_THAT(starting(clip, {.memory_bytes = 1000}), SaysOneLine("one frame takes"));
  EXPECT_THAT(starting(clip, {.loop = hal::LoopMode::kPingPong}), SaysOneLine("needs memory"));
}

TEST(StartCamera, ACameraInUseIsBadInput) {
  hal::fake::FakeClock clock;
  const ImageView picture;
  hal::fake::FakeCamera camera({.pictures = {&picture, 1}}, clock);
  camera.FailStarts(1, Errc::kBusy);
  EXPECT_THAT([&] { StartCamera(camera, "v4l2:/dev/video0"); }, SaysOneLine("/dev/video0"));
}

TEST(StartCamera, PlaysAVideoByItsAddressOrItsPath) {
  const std::string clip = FACEWIRE_ASSETS "/footage/franck.mp4";
  hal::fake::FakeClock clock;
  for (const std::string& address : {clip, "replay:" + clip}) {
    const auto camera = MakeCamera(address, {.pace = hal::Pace::kFast}, clock);
    StartCamera(*camera, address);
    EXPECT_TRUE(camera->Acquire(milliseconds(0)));
  }
}

TEST(StartCamera, AFailureAtWorkIsNotBadInput) {
  hal::fake::FakeClock clock;
  const ImageView picture;
  hal::fake::FakeCamera camera({.pictures = {&picture, 1}}, clock);
  camera.FailStarts(1, Errc::kIo);
  EXPECT_THROW(StartCamera(camera, "v4l2:/dev/video0"), Failure);
}

TEST(DescribeCameraError, NamesASilentCamera) {
  hal::fake::FakeClock clock;
  const auto camera = MakeCamera("v4l2:/dev/video0", {}, clock);
  EXPECT_THAT(DescribeCameraError(Errc::kTimeout, *camera, "v4l2:/dev/video0"),
              HasSubstr("/dev/video0 is silent"));
}

}  // namespace
}  // namespace facewire::app
