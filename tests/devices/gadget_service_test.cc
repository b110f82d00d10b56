// The real programs on devices of the kernel: facewired with a camera and a serial line, the
// operator's command at the other end of it.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <memory>
#include <regex>
#include <string>

#include "tests/app/process.h"
#include "tests/app/scratch.h"
#include "tests/devices/gadget.h"
#include "tests/devices/vivid.h"

namespace facewire::devices {
namespace {

using app::Process;
using std::chrono::seconds;
using ::testing::HasSubstr;
using ::testing::Not;

// Where the emulated machine has them.
constexpr const char* kService = "/facewire/bin/facewired";
constexpr const char* kCommand = "/facewire/bin/facewire";
constexpr const char* kNetworks = "/facewire/networks";

class GadgetServiceTest : public ::testing::Test {
 protected:
  void SetUp() override {
    PlugCable();
    if (VideoNode(Vivid::kCapture).empty()) Vivid::Plug();
    vivid.SelectInput(0);
    scratch.Write("facewire.toml", "[camera]\ndevice = \"v4l2:" + vivid.node() +
                                       "\"\n[tracker]\nnetworks = \"" + kNetworks +
                                       "\"\n[character]\nrig = \"/facewire/share/otto.toml\"\n"
                                       "profile = \"/facewire/share/average.profile\"\n"
                                       "[neutral]\nfolder = \"state\"\n[host]\nline = \"serial:" +
                                       kHostTty + "\"\n");
  }
  void TearDown() override {
    if (HasFailure() && service) std::printf("service: %s\n", service->err().c_str());
    PlugCable();
    if (VideoNode(Vivid::kCapture).empty()) Vivid::Plug();
  }

  void StartService() {
    service = std::make_unique<Process>(
        std::vector<std::string>{kService, "--config", scratch / "facewire.toml", "--stats-json",
                                 scratch / "stats.json"},
        scratch / "service.out", scratch / "service.err");
  }
  void ServiceSays(const std::string& text) {
    WaitUntil("the service to say '" + text + "'",
              [&] { return service->err().find(text) != std::string::npos; });
  }
  int EndService() {
    service->Signal(SIGTERM);
    return service->Wait(seconds(180));
  }
  double Statistic(const std::string& name) const {
    const std::string text = app::ReadAll(scratch / "stats.json");
    std::smatch found;
    if (!std::regex_search(text, found, std::regex('"' + name + "\": ([-0-9.e+]+)"))) return -1;
    return std::stod(found[1]);
  }
  // What the operator's command says, on whose end "exit code N" is put.
  std::string Command(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), kCommand);
    Process command(arguments, scratch / "command.out", scratch / "command.err");
    const int code = command.Wait(seconds(60));
    return command.out() + command.err() + "exit code " + std::to_string(code) + "\n";
  }
  std::string Monitor(const std::string& length) {
    return Command({"monitor", kGadgetTty, "--seconds", length, "--summary"});
  }

  app::Scratch scratch;
  Vivid vivid;
  std::unique_ptr<Process> service;
};

// Frames that the line did not take before anybody listened count as lost, and are no damage.
constexpr const char* kSound = "damage: 0 crc errors, 0 cut,";

TEST_F(GadgetServiceTest, SearchesAPictureWithoutAFaceAndSendsSoundFrames) {
  StartService();
  ServiceSays("searching");
  const std::string heard = Monitor("8");
  EXPECT_THAT(heard, HasSubstr(kSound));
  EXPECT_THAT(heard, HasSubstr("exit code 0"));
  EXPECT_EQ(EndService(), 0) << service->err();
  EXPECT_THAT(service->err(), Not(HasSubstr("fault")));
  EXPECT_GT(Statistic("frames"), 3);
  EXPECT_EQ(Statistic("faces"), 0);
  EXPECT_EQ(Statistic("camera_restarts"), 0);
  EXPECT_EQ(Statistic("line_errors"), 0);
  EXPECT_GT(Statistic("poses_sent"), 3);
  std::printf("service: %smonitor: %s", service->out().c_str(), heard.c_str());
}

TEST_F(GadgetServiceTest, SpeaksAgainAfterItsCableWasPulled) {
  StartService();
  ServiceSays("searching");
  PullCable();
  ServiceSays("the line to the host is gone");
  PlugCable();
  WaitUntil("poses to arrive again", [&] {
    const std::string heard = Monitor("3");
    return heard.find("of them 0 poses") == std::string::npos &&
           heard.find(kSound) != std::string::npos;
  });
  EXPECT_EQ(EndService(), 0) << service->err();
}

TEST_F(GadgetServiceTest, SeesAgainAfterItsCameraWasPulledOut) {
  StartService();
  ServiceSays("searching");
  Vivid::Unplug();
  ServiceSays("fault");
  // Nothing to see is no reason to fall silent.
  EXPECT_THAT(Monitor("2"), HasSubstr(kSound));
  Vivid::Plug();
  WaitUntil("the service to search again", [&] {
    const std::string said = service->err();
    return said.rfind("searching") > said.rfind("fault");
  });
  EXPECT_EQ(EndService(), 0) << service->err();
  EXPECT_GE(Statistic("camera_restarts"), 1);
}

TEST_F(GadgetServiceTest, AServiceWhoseCameraIsTakenSaysSoAndEnds) {
  StartService();
  ServiceSays("searching");
  Process second({kService, "--config", scratch / "facewire.toml", "--read-only"},
                 scratch / "second.out", scratch / "second.err");
  EXPECT_EQ(second.Wait(seconds(60)), 2);
  EXPECT_THAT(second.err(), HasSubstr("another program is using the camera"));
  EXPECT_EQ(EndService(), 0) << service->err();
}

TEST_F(GadgetServiceTest, DoctorListsCamerasAndPorts) {
  const std::string found = Command({"doctor", "--json", "--networks", kNetworks});
  EXPECT_THAT(found, HasSubstr(R"("verdict":"OK","found":"v4l2:)" + vivid.node() + '"'));
  EXPECT_THAT(found, HasSubstr(std::string(R"("verdict":"OK","found":")") + kHostTty + '"'));
  EXPECT_THAT(found, HasSubstr("exit code 0"));
}

TEST_F(GadgetServiceTest, TracksFromTheCameraItselfAndFindsNobody) {
  Process track({kCommand, "track", "v4l2:" + vivid.node(), "--out", scratch / "track.jsonl",
                 "--networks", kNetworks},
                scratch / "track.out", scratch / "track.err");
  // It writes beside the file and renames that at the end.
  WaitUntil("the first lines", [&] {
    for (const auto& entry : std::filesystem::directory_iterator(scratch.folder())) {
      if (entry.path().filename().string().starts_with("track.jsonl")) return entry.file_size() > 0;
    }
    return false;
  });
  track.Signal(SIGINT);
  EXPECT_EQ(track.Wait(seconds(180)), 0) << track.err();
  const std::string lines = app::ReadAll(scratch / "track.jsonl");
  EXPECT_THAT(lines, HasSubstr("\"state\":\"searching\""));
  EXPECT_THAT(lines, Not(HasSubstr("\"state\":\"tracking\"")));
}

}  // namespace
}  // namespace facewire::devices
