#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <regex>
#include <string>
#include <thread>
#include <tuple>
#include <vector>

#include "tests/app/facewired.h"

// The rigs and buses of tools/examples/animatronic as a builder uses them, and a clip that drives
// all four hosts at once.
namespace facewire::app {
namespace {

using testing::HasSubstr;

constexpr const char* kExample = FACEWIRE_SOURCE_DIR "/tools/examples/animatronic/";

std::string Example(const std::string& file) { return Scratch::Read(kExample + file); }

bool Eventually(const std::function<bool()>& done) {
  for (int i = 0; i < 12'000 && !done(); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return done();
}

struct Head {
  // What a builder appends to the two files.
  Head(const std::string& servos, const std::string& buses)
      : facewired(Configuration(buses, "rig.toml")) {
    facewired.scratch.Write("rig.toml", Scratch::Read(kRig) + Example(servos));
  }
  std::string Path(const std::string& name) const {
    return (facewired.scratch / name.c_str()).string();
  }
  // The program of a simulated bus with the bus's name; waits for its line.
  void Simulate(const std::string& bus, std::vector<std::string> command) {
    command.insert(command.end(),
                   {"--pose", "random", "--link", Path(bus), "--trace", Path(bus + ".csv")});
    simulated.push_back(std::make_unique<Process>(command, Path(bus + ".log"), Path(bus + ".err")));
    const auto ready = [&] { return simulated.back()->out().find('\n') != std::string::npos; };
    ASSERT_TRUE(Eventually(ready)) << simulated.back()->err();
  }
  Facewired facewired;
  std::vector<std::unique_ptr<Process>> simulated;
};

TEST(AnimatronicExample, IsAcceptedByTheService) {
  for (const auto& [servos, buses, words] :
       {std::tuple("first_servos.toml", "first_bus.toml", "servos   5"),
        std::tuple("head_servos.toml", "head_buses.toml", "servos   16")}) {
    Head head(servos, Example(buses));
    Process check = head.facewired.Start({"--check"});
    EXPECT_EQ(check.Wait(), 0) << check.err();
    EXPECT_THAT(check.out(), HasSubstr(words));
  }
}

// head_buses.toml with every bus on a line of its name.
std::string BusesHere() {
  std::string buses = Example("head_buses.toml");
  for (const char* bus : {"mouth", "eyes", "neck", "lids"}) {
    buses = std::regex_replace(
        buses,
        std::regex(std::string("(name = \"") + bus + "\"\\nkind = [^\\n]*\\nport = )[^\\n]*"),
        std::string("$1\"serial:") + bus + "\"");
  }
  return buses;
}

TEST(AnimatronicExample, DrivesFourHostsWithOneClip) {
  std::string buses = BusesHere();
  if (std::string(SIM_RECEIVER).empty()) {  // no simulator of its processor here
    buses = Replaced(buses, "\"receiver\"", "\"maestro\"");
  }
  Head head("head_servos.toml", buses);
  head.Simulate("mouth", {SIM_BUS, "maestro"});
  head.Simulate("eyes", {SIM_BUS, "xl330", "--servos", "3", "--baud", "57600"});
  head.Simulate("neck", {SIM_BUS, "sts", "--servos", "3"});
  if (std::string(SIM_RECEIVER).empty()) {
    head.Simulate("lids", {SIM_BUS, "maestro"});
  } else {
    head.Simulate("lids", {SIM_RECEIVER, "--servos", "6"});
  }

  Process service = head.facewired.Start();
  ASSERT_TRUE(Eventually([&] { return std::filesystem::exists(head.Path("line")); }))
      << service.err();
  Process monitor = Tool(head.facewired, {"monitor", head.Path("line"), "--frames", "336",
                                          "--summary", "--csv", head.Path("wire.csv")});
  ASSERT_EQ(monitor.Wait(), 0) << monitor.err();  // fourteen seconds of the clip
  service.Signal(SIGTERM);
  ASSERT_EQ(service.Wait(), 0) << service.err();
  for (const auto& bus : head.simulated) {
    bus->Signal(SIGTERM);
    EXPECT_EQ(bus->Wait(), 0) << bus->err();
  }

  std::vector<std::string> sheet{
      "sheet", head.Path("wire.csv"),  "--config", head.Path("facewire.toml"), "--check",
      "--out", head.Path("servos.png")};
  const auto add = [&](const std::string& bus, const std::vector<std::string>& servos) {
    for (std::size_t i = 0; i < servos.size(); ++i) {
      sheet.insert(sheet.end(), {"--servo", servos[i] + "=" + head.Path(bus + ".csv") + ":" +
                                                std::to_string(i)});
    }
  };
  add("mouth", {"jaw", "corner_L", "corner_R", "lower_lip"});
  add("eyes", {"eye_yaw_L", "eye_yaw_R", "eyes_pitch"});
  add("neck", {"neck_yaw", "neck_piston_L", "neck_piston_R"});
  // A computer that is too busy for the simulated processor shows nothing of the firmware.
  const std::string lids = head.simulated.back()->out();
  if (lids.find("too slow") == std::string::npos) {
    add("lids", {"lid_upper_L", "lid_upper_R", "lid_lower_L", "lid_lower_R", "brow_L", "brow_R"});
  }
  Process draw = Tool(head.facewired, sheet);
  EXPECT_EQ(draw.Wait(), 0) << draw.err() << draw.out() << lids;
  EXPECT_TRUE(std::filesystem::exists(head.Path("servos.png")));
}

}  // namespace
}  // namespace facewire::app
