#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/tools/facewire/run.h"

namespace facewire::tools {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(FacewireDoctor, SaysWhatIsMissingAndWhatFixesIt) {
  const Outcome outcome = RunFacewire({"doctor", "--networks", "/nowhere"});
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(outcome.out, HasSubstr("FAIL  networks"));
  EXPECT_THAT(outcome.out, HasSubstr("-> tools/setup"));
  EXPECT_THAT(outcome.out, HasSubstr("clock"));
}

TEST(FacewireDoctor, ReadsTheConfigurationThatItIsGiven) {
  const Scratch scratch;
  const std::string config = scratch.Write("f.toml", "[camera]\nwidth = 3\n");
  const Outcome outcome = RunFacewire(
      {"doctor", "--config", config, "--networks", FACEWIRE_ASSETS "/networks", "--json"});
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(outcome.out, HasSubstr("{\"check\":\"networks\",\"verdict\":\"OK\""));
  EXPECT_THAT(outcome.out, HasSubstr("{\"check\":\"configuration\",\"verdict\":\"FAIL\""));
}

TEST(FacewireDoctor, LooksAtThePortsOfServoBuses) {
  const Scratch scratch;
  const std::string config = scratch.Write(
      "f.toml", "[character]\nrig = \"" FACEWIRE_SOURCE_DIR
                "/app/share/otto.toml\"\n[[bus]]\nname = \"face\"\nkind = \"maestro\"\nport = "
                "\"serial:/dev/no-such-port\"\n");
  const Outcome outcome = RunFacewire({"doctor", "--config", config});
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(outcome.out, HasSubstr("FAIL  bus face       there is no port /dev/no-such-port\n"));
  EXPECT_THAT(outcome.out, HasSubstr("FAIL  servos         bus \"face\": no servo of the rig is on "
                                     "it"));
}

TEST(FacewireDoctor, LooksAtTheHostLineAndSaysWhoReadsItsProtocol) {
  const Scratch scratch;
  const auto doctor = [&](const std::string& host) {
    const std::string rig = "[character]\nrig = \"" FACEWIRE_SOURCE_DIR "/app/share/otto.toml\"\n";
    const std::string config = scratch.Write("f.toml", rig + "[host]\n" + host);
    return RunFacewire({"doctor", "--networks", FACEWIRE_ASSETS "/networks", "--config", config})
        .out;
  };
  EXPECT_THAT(
      doctor("line = \"serial:/dev/no-such-port\"\nbaud = 57600\n"),
      HasSubstr("WARN  host line      there is no port /dev/no-such-port; 57600 baud, native "
                "protocol\n                     -> plug it in, or correct [host] line"));
  EXPECT_THAT(
      doctor("line = \"pty:/tmp/face\"\nprotocol = \"osc\"\n"),
      HasSubstr("OK    host line      pty:/tmp/face, which the service makes; OSC over SLIP: the "
                "page, facewire monitor and the bridges cannot read it\n"));
  EXPECT_THAT(doctor("line = \"none\"\n"),
              HasSubstr("OK    host line      none: values go to servos alone\n"));
}

// Whatever cameras this machine has: a list and success, or one line that says why not.
TEST(FacewireDoctor, ListsTheCamerasAndNothingElse) {
  for (const bool json : {false, true}) {
    std::vector<std::string> arguments = {"doctor", "--cameras"};
    if (json) arguments.emplace_back("--json");
    const Outcome outcome = RunFacewire(arguments);
    EXPECT_THAT(outcome.out, Not(HasSubstr("networks")));
    if (outcome.code == 0) {
      EXPECT_THAT(outcome.out, HasSubstr(json ? "{\"address\":" : "  device = \""));
    } else {
      EXPECT_EQ(outcome.code, 1);
      EXPECT_THAT(outcome.err, HasSubstr("camera"));
    }
  }
}

}  // namespace
}  // namespace facewire::tools
